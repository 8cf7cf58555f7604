"""Find out whether a sentence commits to what it says: reports, wishes, plans, the past, conditions, corrections."""

from __future__ import annotations

import re

from deixis.grammar.english.rewording import DOUBT
from deixis.grammar.english.tree import Mood, Sentence
from deixis.grammar.english.vocabulary.function_words import NUMBERS, OTHER_UNITS, READY, UNITS
from deixis.grammar.english.vocabulary.nouns import PEOPLE
from deixis.grammar.english.vocabulary.verbs import SAYING

PAST_RELATIVE = re.compile(
    r"\b(?:which|that|who)\s+(?:used to|was|were|had)\b"
    r"|\b(?:formerly|previously|originally|once)\s+(?:on|in|at|under|behind|next|left|right|beside|near|above|below|inside)\b"
    r"|\b(?:which|that)\s+(?:(?:the|an?|my|his|her|our|their)\s+)?(?:[\w'\u2019-]+\s+){0,3}?(?:stood|hung|lay|sat)\b"
    r"|\b(?:which|that|who)\s+for\s+(?:[\w'\u2019-]+\s+){0,3}?(?:years?|months?|weeks?|decades?|centuries|generations?)\b"
    r"|\b(?:which|that|who|where)\s+(?:[\w'\u2019-]+\s+){0,3}?once\s+\w+",
    re.IGNORECASE,
)
"""Beginning of a relative clause in the past."""

LEFT = re.compile(r"^[\s,;]*but\s+(?:i|we|he|she|they|someone)\s+(?:left|put|placed)\b", re.IGNORECASE)
"""Beginning of a clause by which what should be is not so."""
NOW = re.compile(r"\b(?:was|were|stood|lay|sat|hung)\s+now\b|\bnow\s+(?:stood|lay|sat|hung)\b", re.IGNORECASE)
"""Words by which a story says what is so in the end."""
HABIT = re.compile(
    r"(?<!\bis )(?<!\bare )(?<!\bbe )\b(?:always|usually|often|normally|generally)\s+"
    r"(?:kept|stored|put|placed|had|left(?!\s+of\b)|stood|lay|hung|sat)\b"
    r"|\b(?:days?|weeks?|months?|years?|hours?)\s+ago\b"
    r"|(?<=\w\s)(?<!that\s)(?<!which\s)(?<!who\s)(?<!where\s)once\s+(?:\w+ed|kept|put|had|left(?!\s+of\b)|stood|lay|laid|hung|sat|held|set|stuck|hid)\b",
    re.I,
)
"""Words of what was done again and again, or at an earlier time."""
WHILE_DOING = re.compile(
    r"\s*(?:when|while|if|before|after)\s+(?!facing|looking|standing|sitting|seen|entering|viewed"
    r"|(?:setting|laying|arranging|preparing|packing|assembling|building|installing|placing|positioning|organi[sz]ing|loading|filling|stacking"
    r"|storing|hanging|mounting|stocking|planting|plating|packing|unpacking|moving"
    r"|styling|decorating)\b)[a-z]+ing\b[^,]*,",
    re.IGNORECASE,
)
"""Condition at the beginning of a sentence: *when driving, …*.

What tells a viewpoint is not one, and neither is the arranging that the text is about: *when setting a table, …*.
"""
_IN_STATE = re.compile(
    r"\s*(?:when|while|whenever)\s+((?:not\s+)?(?:(?:in|on|at|under|out\s+of)\s+[a-z]+|[a-z]+(?<!ing)(?<!\bseen)(?<!\bviewed)"
    r"(?:\s+(?:and|or)\s+[a-z]+)?))\s*,",
    re.IGNORECASE,
)
"""State at the beginning of a sentence, in which alone it holds: *when wet, …*, *when not in use, …*."""
_IN_ORDER = re.compile(r"\s*(?:before|after)\b", re.IGNORECASE)
"""Beginning of a step that follows or precedes another one."""
CONDITION = re.compile(
    r"\s*(?:if(?!\s+you\s+(?:look|peek|peep|peer|open|lift)\b[^,]*,\s*you\b)|unless|whenever|assuming|suppose|supposing|provided|providing|in\s+case|in\s+the\s+event|"
    r"(?:as|so)\s+long\s+as|(?:only|even)\s+if|on\s+condition|depending\s+on)\b"
    r"|\s*(?:given|granted|with)\s+(?:any\s+|a\s+bit\s+of\s+|enough\s+|sufficient\s+|more\s+)?"
    r"(?:luck|room|space|time)\b[^,.;?]*,"
    r"|\s*(?:should|were)\s+(?!be\b)[^,.;?]*,|\s*without\s+(?!\w+ing\b)[^,.;?]*,",
    re.IGNORECASE,
)
"""Beginning of a sentence that holds under a condition: *if …*, *in the event of …, …*, *should it rain, …*."""
_INSERTED_CONDITION = re.compile(
    r"[^,;:.()]*[,(]\s*((?:but\s+|and\s+)?(?:only\s+|even\s+)?(?:if|unless|whenever|when|in\s+case|provided)\b[^,;:.()]*)[,)]",
    re.IGNORECASE,
)
"""Condition between the subject of a clause and its place: *The spoon, if there is soup, lies …*."""
UNSURE_RELATIVE = re.compile(
    r"\b(?:which|that|who)\s+(?:(?:was|were|is|are)\s+to\b|(?<!,\swhich\s)should\b|might\b|may\b|could\b|would\b)",
    re.IGNORECASE,
)
"""Beginning of a relative clause that tells what should be or might be; *…, which should …* adds an instruction."""

OBLIGED = frozenset({"should", "ought", "shall"})
REVOKED = re.compile(
    r"^,?\s*(?:but|though|yet)\s+not\s+(?:today|now|here|yet|always|any\s*more|this\s+time|tonight|any\s+longer)\b|"
    r"^[,;]?\s*(?:(?:but|though|although|yet)\s+)?(?:we|i|you|they|he|she|it)\s+"
    r"(?:do|does|did|is|are|was|were|wo|ca|have|has|never)(?:n['\u2019]t|\s+not)?\s*[.!]?$"
    r"|^,?\s*or\s+(?:else\s+)?(?:not|(?:it|they|he|she)\s+(?:is|are|was|were|do|does|did)(?:n['\u2019]t|\s+not))\s*[.!]?$",
    re.IGNORECASE,
)
"""End of a sentence that takes back what it said: *…, but we don't*."""
_PUTTING = (
    "placing|putting|laying|positioning|arranging|keeping|storing|installing|mounting|attaching|adding|moving|stacking"
    "|having|leaving|setting|inserting|fixing|aiming|directing|centring|centering|locating|situating|spreading|tucking"
)
_POSING = "hanging|standing|leaning|resting|folding|rolling|turning|pointing|facing|angling|tilting|balancing|stringing"
"""Participles that stand before nouns as well: *hanging lamps*."""
_PREPOSITIONS = "on|in|into|onto|at|under|next|behind|above|over|below|beside|near|against|between|from|by|to|towards?"
UNREAL = re.compile(
    r"^\s*(?:according to|rumou?r has it|they say|people say|some say|word has it|supposedly|allegedly|legend has it)\b"
    r"|\b(?:i|we|he|she|they)\s*(?:['\u2019]d|would)\s+(?:like|love|prefer|rather|sooner)\b"
    r"|(?<!['\u2019])\b(?!you\b)(?!(?<=\byou\s)will\b)(?<!\bif\s)(?<!\bif\sit\s)"
    r"(?:i|we|he|she|they|[A-Z][a-z]+)\s+(?:wants?|wanted|hopes?|hoped|wish(?:es|ed)?|plans?|planned|tried|tries|intends?|intended|"
    r"dream(?:s|t|ed)|forgot|refused?|failed)\s+(?:[\w'\u2019]+\s+){0,5}?(?:to|that)\b"
    r"|\bso\s+(?:the|my|his|her|our|their)?\s*[\w'\u2019]+\s+(?:says?|said|claims?|thinks?|believes?|told|hopes?)\b"
    r"|\bwhich\s+(?:is|was)\s+(?:wrong|false|untrue|nonsense|a mistake|an error|not true|not right)\b"
    r"|\b(?:i|we|you|he|she|they)\s+(?:was|were|are|am|is)\s+(?:asked|told|supposed|reminded|instructed|ordered)\s+to\b"
    r"|\b(?:imagin(?:es?|ed)|pretend(?:s|ed)?|dream(?:s|t|ed)?)\s+(?:that|a|an|the)\b"
    r"|\b(?:i|we|he|she|they)\s+(?:hopes?|wish(?:es)?|fears?)\s+(?:the|an?|my|his|her|our|their|it)\b"
    r"|\b(?:i|we|he|she|they)(?:['\u2019]d|\s+had|['\u2019]ve|\s+have)\s+(?:planned|hoped|wanted|intended|meant)\s+to\b"
    r"|\b(?:is|are)\s+what\s+(?:[\w'\u2019]+\s+){1,3}?(?:demand|want|say|need|call|require|expect|ask|like|suggest)s?\b"
    r"|\b(?:miss|avoid|escap)(?:e?s|ed|ing)?\s+\w+ing\b"
    r"|\b(?:less|more|rather)\s+(?:on|in|under|behind|beside|above|below|inside|near|at)\b[^.;]*\bthan\b"
    r"|\b(?:far|further|farther)\s+from\s+(?:the\s+)?(?:truth|true)\b"
    r"|\b(?:you|one|we|i)(?:['\u2019]d|\s+would)\s+(?:expect|think|believe|swear|suppose)\b"
    r"|(?:['\u2019]d|\bwould)\s+(?:have|like|want|prefer)\s+(?:you|us|me|him|her|them|people|everyone|the|a|an)\b"
    r"|(?<!\bto\s)\b(?:stop|prevent|save|discourage|hinder|protect)(?:s|ed|ing)?\s+(?:[\w'\u2019]+\s+){1,4}?from\s+\w+ing\b"
    r"|\b(?:stop|prevent)\s+(?:[\w'\u2019]+\s+){1,4}?from\s+(?:stand|sitt|ly|hang|rest|lean|be|go|touch|stay|land)ing\b"
    r"|\beither\s+(?:[\w'\u2019]+\s+){1,4}?(?:is|are|stands?|lies?|goes|sits?|hangs?)\s[^.;]*\bor\s+(?:else\s+)?"
    r"(?:it|they|he|she|we|i|you|some\s?(?:body|one)|the|an?|my|his|her|our|their)\b"
    r"|\blet(?:['\u2019]s|\s+us)\s+(?:hope|say|suppose|assume|pretend|imagine)\b"
    r"|\b(?:plan|idea|intention|hope|wish|dream|aim)\s+(?:is|was)\s+to\b"
    r"|(?<=[a-z]\s)(?:asks?|asked|tells?|told|orders|ordered|begs|begged|urge[sd]?|advise[sd]?|persuade[sd]?|expect(?:s|ed)|commanded)\s+"
    r"(?:[\w'\u2019]+\s+){1,3}?(?:not\s+)?to\s+(?!the\b)[a-z]+"
    r"|\b(?:suggest(?:s|ed)|propos(?:es|ed)|recommend(?:s|ed))\s+(?:that\s+)?(?:we|i|he|she|they)\b"
    r"|\b(?:refus(?:es?|ed)|declin(?:es?|ed)|forgot|forgets|neglect(?:s|ed)?|omit(?:s|ted)|"
    r"hesitat(?:es|ed))\s+to\b|\b(?:look|search|hunt|ask|wish)(?:s|es|ed|ing)?\s+for\s+(?:an?|some|any)\b"
    r"|^\s*in\s+(?:the|an?|this|that|his|her|my|our|your|their|one|[\w-]+['\u2019]s?)\s+(?:[\w'\u2019-]+\s+){0,2}?(?:story|novel|tale|fable|"
    r"legend|myth|poem|song|film|movie|dream|nightmare|cartoon|joke|riddle|painting|mural|tapestry|portrait)\b"
    r"|\b(?:think|dream|talk|read|hear|speak|complain)(?:s|ing|ed)?\s+(?:of|about)\b"
    r"|\bwill\s+have\s+(?:been|stood|lain|\w+ed)\b"
    r"|\b(?:i|we)(?:['\u2019](?:m|re|ve\s+been)|\s+(?:am|are|was|were|have\s+been))\s+(?:told|informed|assured|given\s+to)\b"
    r"|\b(?:wants|wanted)\s+(?:the|an?|my|his|her|our|their|it|them)\b|\bover\s+(?:my|his|her|our)\s+dead\s+body\b"
    r"|\b(?:supposedly|allegedly|reportedly|purportedly|ostensibly|theoretically|hypothetically)\b"
    r"|^\s*picture\s+this\b|\btry\s+to\s+(?:picture|imagine|visuali[sz]e)\b|\bis\s+(?:an?\s+)?(?:accident\s+waiting|bad\s+luck|good\s+luck|recipe\s+for|(?:fire\s+)?hazard|"
    r"crime|sin|joke|figment|fantasy|fiction|lie|illusion|dream)\b"
    r"|\binsist(?:s|ed)?\s+(?:up)?on\b|\byou['\u2019]ll\s+be\s+(?:telling|saying)\b|\bis\s+the\s+least\b"
    r"|\bthe\s+(?:author|painter|artist|playwright|novelist|poet|director|engraver)\s+(?:has|had|puts|places|shows)\b"
    r"|,\s*an?\s+(?:error|mistake|slip|misprint)\b"
    r"|\bwhich\s+(?:i|we)\s+(?:doubt|deny|(?:do\s+not|don['\u2019]t)\s+(?:believe|think))\b"
    r"|\b(?:sign|label|note|card|notice|poster|plaque|caption|sticker)\s+(?:reads?|says?)\s*:"
    r"|\b(?:wrongly|mistakenly|incorrectly|erroneously)\b|\b(?:urge|temptation|impulse)\s+to\b"
    r"|\bnothing\s+like\s+(?:as|so)\b|\ball\s+that(?:['\u2019]s|\s+is)\s+(?:missing|lacking|needed)\b"
    r"|\b(?:it|things)\s+looks?\s+(?:as\s+(?:if|though)|like)\b"
    r"|\b(?:theory|theories|story|map|guidebook|article|account|version|testimony|rumou?r|legend|myth|tradition|report|guess|hypothesis)\s+"
    r"(?:puts?|places?|has|locates?|says?|holds?|goes|claims?|suggests?)\b"
    r"|\b(?:says?|tells?|suggests?|shows?|proves?|know|knows|thinks?)\s+(?:us\s+)?(?:otherwise|differently)\b"
    r"|(?:^|[,;]\s*)(?:the|this|that|one|an?)\s+(?:old\s+)?(?:picture|photo|photograph|painting|drawing|catalogue|advert(?:isement)?|"
    r"brochure|leaflet|postcard|poster|film|video)\s+(?:pictures?|shows?|depicts?|portrays?)\b"
    r"|\b(?:mistake|error|myth|misconception|illusion)\s+(?:to|that)\b"
    r"|\bin\s+(?:the|this|that|a)\s+(?:picture|photo(?:graph)?|painting|film|story|novel|dream)\s*[.!]?$"
    r"|\b(?:is|are)\s+due\s+(?:on|in|at|under|behind|next|back)\b"
    rf"|^\s*(?:{_PUTTING})\s+(?!(?:{_PREPOSITIONS})\b)[^,;:.]*?\b(?:is|are|was|can|may|will|would|makes?|gives?|creates?|means?)\b"
    r"(?!\s+(?:also\s+|often\s+|usually\s+)?(?:an?\s+|the\s+)?(?:good|great|best|better|ideal|important|helpful|useful"
    r"|convenient|easiest|safest|essential|key|perfect|help|save|keep|allow|ensure|reduce|free|protect)\b)"
    rf"|^\s*(?:{_POSING})\s+(?!(?:{_PREPOSITIONS})\b)[^,;:.]*?\s(?:{_PREPOSITIONS})\s[^,;:.]*?\b(?:is|was|makes|gives|creates|means)\b"
    r"|^\s*on\s+the\s+(?:cover|front\s+page|back\s+cover|poster|postcard|stamp|billboard)\b[^,.;]*,",
    re.IGNORECASE,
)
"""Words of a sentence that tells what a person says, wants, asks for or tries, or that retells a story."""
_SPEAKERS = rf"(?:he|she|they|others|everybody|everyone|some\s?(?:body|one)|{'|'.join(sorted(PEOPLE))})s?"
_SAYING = "|".join(sorted(SAYING))
REPORTED = re.compile(
    rf"\b{_SPEAKERS}\s+(?:{_SAYING})\s+(?:the|an?|my|his|her|our|their|your|it|they|there|(?-i:[A-Z]))\b"
    rf"|\b(?:some|many|most|others|people|they)\s+(?:claim|say|think|believe|swear|insist|argue)\s",
    re.IGNORECASE,
)
"""Words of a sentence that tells what other people say: *my son insists the ball is …*."""
SAID_AFTER = re.compile(
    rf",\s*(?:or\s+so\s+|so\s+)?(?:(?:my|his|her|our|their|the)\s+)?{_SPEAKERS}\s+(?:{_SAYING})\s*[.!]?$", re.IGNORECASE
)
"""End of a sentence that tells what other people say: *the cup is on the tray, he says*."""
FRAMED = re.compile(
    r"^\W*(?:(?:and|but|so|well|now)\s+)?(?:"
    r"(?:in|on)\s+(?:theory|principle|paper|hypothesis|fiction)\b"
    r"|in\s+(?:an?|the|my|his|her|our|their|your|this|some)\s+(?:[\w-]+\s+)?"
    r"(?:world|dreams?|opinion|view|mind|imagination|fantasy|eyes|book|plan|sketch|photo|photograph|painting|portrait|poem|film|movie|video|mirror|catalogue)\s*(?:,|(?=(?:the|an?|my|her|his|[\w-]+['\u2019]s)\s))"
    r"|in\s+(?:other|some|many|most|certain|several|different|these|those|such)\s+(?:countries|families|houses|homes|households"
    r"|cultures|regions|places|restaurants|kitchens|schools|offices|hotels|traditions|settings|situations|scenarios"
    r"|circumstances|versions|designs|models|setups|cities|areas|religions)\b"
    r"|(?:at\s+(?:best|worst)|for\s+all\s+(?:i|we)\s+know|who\s+knows|with\s+any\s+luck|god\s+knows)\b"
    r"|(?:to\s+(?:hear|believe|judge))\s|contrary\s+to\b"
    r"|(?:reportedly|allegedly|supposedly|hypothetically|theoretically|ostensibly|purportedly|conceivably|potentially)\b"
    r"|(?:the\s+(?:moment|day|minute|instant)|every\s+time|each\s+time|any\s+time|lest|for\s+fear)\s"
    r")",
    re.IGNORECASE,
)
"""Beginning of a sentence about another world than the one on the table: *in theory*, *the moment it is …*."""
SELDOM = re.compile(
    r"(?:\bnot|n['\u2019]t)\s+(?:always|usually|normally|generally|often|necessarily|every\s+day|all\s+the\s+time)\b|"
    r"(?<!\ba\s)(?<!\bthe\s)(?<!\bthese\s)(?<!\blast\s)(?<!\bfirst\s)(?<!\bnext\s)(?<!\bevery\s)\bfew\s|\b(?:scarcely|hardly)\s+(?:lies?|stands?|sits?|hangs?|belongs?)\b|\bexcepted\b",
    re.IGNORECASE,
)
"""Words by which something is so at times, or of some things."""
AT_MOST = re.compile(
    r"\b(?:at\s+most|(?:no|not)\s+more\s+than|fewer\s+than|less\s+than|up\s+to|a\s+maximum\s+of)\s+"
    rf"(?:{'|'.join(NUMBERS)}|\d+)\s+(?!(?:{'|'.join(UNITS)}|{'|'.join(OTHER_UNITS)})s?\b)(?=[a-z])",
    re.IGNORECASE,
)
"""Upper bound of the number of things, which does not say that there are any: *at most two cups*."""
UNSURE = re.compile(
    r"(?:\bnot|n['\u2019]t|\bhardly|\bnever|\bfar\s+from)\s+(?:really\s+|quite\s+|so\s+|at\s+all\s+|even\s+)?"
    r"(?:sure|certain|convinced|clear)\b|\b(?:unsure|uncertain|unclear|doubtful|unlikely)\s+(?:if|that|whether|the|an?)\b",
    re.IGNORECASE,
)
"""Words of a speaker who does not know."""
FUTURE = re.compile(
    r"(?=.*(?:\b(?:will|shall|going\s+to)\b|['\u2019]ll\b))"
    r".*\b(?:tomorrow|later|next\s+(?:time|week|month|year|day|spring|summer|autumn|winter)|(?:some|one)\s*day|soon|eventually)\b",
    re.IGNORECASE | re.DOTALL,
)
"""Sentence about a later time."""
PAST_TIME = re.compile(
    r"\b(?:yesterday|last\s+(?:night|week|month|year|spring|summer|autumn|winter|time)|formerly|originally|back\s+then"
    r"|in\s+those\s+days|in\s+the\s+old\s+days|at\s+(?:the|that)\s+time|once\s+upon\s+a\s+time|years?\s+ago)\b"
    r"|\buntil\s+(?:[\w'\u2019]+\s+){1,3}(?:was|were|had|broke|sold|died|left|came|went|got|took|\w+ed)\b"
    r"|\bbefore\s+(?:[\w'\u2019]+\s+){1,3}(?:was|were|broke|sold|died|left|came|went|got|took|fell|\w+ed)\b"
    r"|\b(?:ceas|stopp|quitt)ed\s+(?:to\s+)?(?:be|being|stand|standing|lying|lie)\b",
    re.IGNORECASE,
)
"""Time at which something was so, and words for its end."""
PRESENT = re.compile(
    r"\b(?:is|are|has|have|stands|lies|hangs|sits|goes|belongs)\b"
    r"|\b(?:it|that|there|here|he|she)['\u2019]s\b|['\u2019](?:re|ve)\b",
    re.IGNORECASE,
)
"""Verbs in the present."""
CONSEQUENCE = re.compile(
    r"^[,;]?\s*(?:and|or)\s+(?:you|it|he|she|they|some\s?(?:body|one)|there|we)(?:['\u2019]ll|\s+will|['\u2019]d|\s+would)\s+"
    r"(?!(?:see|have|find|be\s+(?:ready|done|able|fine))\b)",
    re.IGNORECASE,
)
"""Words after a command that make it a condition: *put it there and you will be sorry*."""
LIMITED = re.compile(
    r"\bonly\s+(?:on|in|at|during|when|for)\s+[^,.;]*|\bon\s+(?:mon|tues|wednes|thurs|fri|satur|sun)days\b"
    r"|\bon\s+(?:holidays|weekends|weekdays|birthdays)\b|\b(?:in|during)\s+(?:the\s+)?(?:summer|winter)\b|\bat\s+night\b"
    r"|\b(?:most|some|many|other)\s+(?:days|nights|mornings|evenings|weekends|weeks|years|times)\b"
    r"|\bin\s+(?:\w+\s+)?weather\b|\bin\s+(?:the\s+)?(?:rain|snow)\b|\bexcepted\b",
    re.IGNORECASE,
)
"""Time outside which a statement need not hold, or a word that leaves things out of it."""
UNTIL = re.compile(r"(?<=\w\s)(?:before|until|till)\s+[^,.;]+", re.IGNORECASE)
"""Time up to which a denial holds: *do not put the cup there before dessert*."""
EVENT = re.compile(
    r"\W*(?:in\s+an?\s+(?:[\w-]+\s+){0,2}(?:game|match|emergency|crisis|storm|drill|power\s+cut|heatwave)\b"
    r"|in\s+(?:the\s+event|case)\s+of\s+[^,.;]*)",
    re.IGNORECASE,
)
"""Beginning of a sentence that tells what is so in an event alone: *in an emergency*, *in the event of rain*."""
ELSEWHERE = re.compile(
    r"\s*at\s+(?:my|our|your|his|her|their|the)\s+(?!own\b)[\w-]+(?:['\u2019]s|s['\u2019])\b[^,.;]*,", re.IGNORECASE
)
"""Place of other people at the beginning of a sentence: *at my neighbour's table*."""


_ASKED = re.compile(
    r"(?:if|in\s+case)\s+(?:you|any\s?(?:one|body)|some\s?(?:one|body)|people|he|she|they|guests)(?:['\u2019](?:re|s)|\s+(?:are|is|ever|should))?\s+"
    r"(?:asks?|asking|wonders?|wondering|looks?\s+for|looking\s+for|(?:needs?|wants?|like)\s+to\s+know)\b",
    re.IGNORECASE,
)
"""Condition of a question that the statement answers, and not of what it states: *if anyone asks, …*."""


def is_condition(text: str) -> bool:
    """Return True unless a condition only says who may ask about what a statement says.

    Parameters
    ----------
    text
        Text of the condition, from its conjunction on.

    Returns
    -------
    bool
        True if the statement holds under the condition alone.

    Examples
    --------
    >>> is_condition("if anyone asks"), is_condition("if it rains")
    (False, True)
    """
    return _ASKED.match(text) is None


def condition_of(sentence: Sentence) -> str | None:
    """Return the condition that a sentence begins with, up to its comma: *If you serve soup, …*.

    Parameters
    ----------
    sentence
        Parsed sentence.

    Returns
    -------
    str or None
        Text of the condition with single spaces, or None for a sentence that does not begin with one.
    """
    in_state = _IN_STATE.match(sentence.text)
    commanded = any(clause.mood is Mood.COMMAND for clause in sentence.clauses)
    if in_state is not None and not (commanded and in_state[1].casefold() in READY):
        return " ".join(in_state[0].strip(" ,").split())
    if DOUBT.match(sentence.text) or not (WHILE_DOING.match(sentence.text) or CONDITION.match(sentence.text)):
        return None
    if commanded and _IN_ORDER.match(sentence.text):
        return None  # 'after washing the cups, put them on the shelf'
    text = " ".join(sentence.text.split(",", 1)[0].split())
    return text if commanded or is_condition(text) else None


def inserted_condition(clause: str) -> str | None:
    """Return the condition that stands between a subject and what is said about it: *The spoon, if there is soup, …*.

    Parameters
    ----------
    clause
        Text of a clause from its subject on.

    Returns
    -------
    str or None
        Text of the condition with single spaces, or None for a clause without one.

    Examples
    --------
    >>> inserted_condition("The spoon, if there is soup, lies next to the knife")
    'if there is soup'
    """
    match = _INSERTED_CONDITION.match(clause)
    return None if match is None else " ".join(match[1].split())
