"""Tell names that a thing can have from words that name none: qualities, acts, times, measures, directions, clauses."""

from __future__ import annotations

from deixis.grammar.english.vocabulary.adjectives import QUALITIES, adjectives
from deixis.grammar.english.vocabulary.function_words import (
    DETERMINERS,
    MODALS,
    NUMBERS,
    OTHER_UNITS,
    POSSESSIVES,
)
from deixis.grammar.english.vocabulary.known_nouns import KnownNouns
from deixis.grammar.english.vocabulary.nouns import ABSTRACT, last_word
from deixis.grammar.english.vocabulary.tables import LITERAL, word_set
from deixis.grammar.english.vocabulary.verbs import verb_forms

_QUALITIES = word_set(
    "level pitch tone volume brightness intensity strength speed temperature pressure angle"
    " amount quantity quality degree extent rate proportion ratio dimension width height depth length thickness"
    " type kind sort class category species shade hue texture finish theme vibe feel feeling sense impression look"
    " balance symmetry harmony contrast interest appeal beauty warmth comfort safety privacy clutter tension strain"
    " posture fatigue health life love peace joy freedom power energy spirit soul mind memory knowledge skill taste"
    " flavour flavor sound silence visibility access accessibility flexibility stability"
)
_ACTS = word_set(
    "step stage phase task job action activity process operation turn move motion start beginning finish"
    " measure delivery attempt try effort adjustment placement presentation preparation installation maintenance"
    " inspection measurement alignment orientation rotation transition conversation communication discussion"
    " interaction circulation navigation storage organisation organization consideration requirement"
    " recommendation suggestion explanation description instruction direction exception idea option"
    " choice decision plan goal aim purpose reason cause result consequence benefit advantage disadvantage drawback"
    " issue problem trouble mistake error question answer example instance case situation circumstance scenario"
    " condition state status way manner method technique approach strategy style fashion habit practice custom"
    " tradition convention norm standard policy etiquette concept principle theory notion belief opinion view"
    " viewpoint perspective importance significance meaning difference similarity relation relationship connection"
    " order sequence priority preference need want wish desire demand use usage reach ease convenience help support"
    " advice guidance reminder warning caution care attention focus emphasis effort work play fun rest sleep exercise"
    " ritual ceremony celebration symbolism representation worship prayer blessing creation impact influence"
    " observation experience event occasion matter fact detail information word culture religion society language"
    " literature career hobby marriage childhood youth opportunity threat challenge success failure progress growth"
    " change trend context aspect factor role budget economy industry trade hospitality courtesy manners behavior"
    " behaviour respect honor honour pride fear anger surprise pleasure pain stress hurry rush chaos size weight hunch"
    " truth rumor rumour talent force pace rhythm war fight talk chat trip journey travel holiday birthday"
    " wedding funeral appetite hunger thirst duty arrival departure overview routine tutorial hint repeat"
    " strike leak flow traffic mess splash burst touch pop dash breath breeze draft draught airflow glare odor odour"
    " sunshine sunlight daylight moonlight germ mildew bacteria"
)
_TIMES = word_set(
    "time moment second minute hour day night morning afternoon evening week weekend month season year century age"
    " today tomorrow yesterday now then beforehand afterwards course duration period while"
    " spring summer autumn winter frost harvest sunrise sunset rain storm"
)
_DIRECTIONS = word_set(
    "left right up down upward upwards downward downwards inward inwards outward outwards forward forwards backward"
    " backwards sideways outside inside clockwise anticlockwise counterclockwise ahead upside away"
)
_UNNAMED = word_set(
    "location area placement vicinity surrounding surroundings whereabouts world distance"
    " inch inches cm mm centimetre centimeter millimetre millimeter kilometre percent o'clock"
    " lot number enough bit rest majority most least dozen"
)
_WITHOUT_PLACE = _QUALITIES | _ACTS | _TIMES | _DIRECTIONS | _UNNAMED | ABSTRACT
"""Last words of phrases that name no thing with a place."""
_KEPT = word_set(
    "measure area date help law company light case work support state finish use reach rest stage rule second"
    " initial standard connection view sound tip matter trace title name story plan order choice play step storage"
    " turn notion"
)
"""Such words that name a thing as the last word of a compound: *book case*, *spirit level*, *foot rest*."""
_SELDOM_THINGS = word_set("level pitch bit outside inside")
"""Such words that the ontology knows, and that are seldom things by themselves."""
_ENDINGS = ("ness", "ance", "ence", "ism", "ship", "tion", "sion", "ment", "tude", "acy", "ity", "logy")
_CONCRETE = word_set(
    "station lotion potion cushion section illustration partition junction portion foundation extension invitation"
    " publication installation composition collection selection plantation solution caption mansion pension fraction"
    " prescription ladyship lordship"
    " television ration medication carnation decoration percussion version intersection ammunition bastion elevation"
    " instrument ornament garment monument cement parchment pigment compartment document equipment element apartment"
    " arrangement movement ointment pavement basement casement segment fragment filament ligament attachment implement"
    " battlement pediment tenement condiment monument refreshment liniment embankment escarpment complement sediment"
    " fence appliance ambulance entrance audience conveyance residence substance essence lance stance science"
    " ship spaceship steamship airship warship harness wilderness witness governess lioness business prism"
    " mechanism organism position settlement allotment"
    " city cavity commodity facility utility university nativity vanity community deity entity extremity celebrity"
    " necessity amenity novelty rarity oddity curiosity charity fraternity trinity"
)
"""Words with the endings of abstract nouns that name things."""
_QUALIFYING = ("ive", "ful", "less", "ous", "able", "ible", "iest", "cest", "gest")
"""Endings of adjectives, and of the superlatives of those in *-y*, *-ce* and *-ge*."""
_NOUNS_LIKE_QUALITIES = word_set(
    "olive chive hive archive endive locomotive relative dive drive native adjective cursive fugitive captive votive"
    " chives detective executive operative representative narrative motive missive alternative additive explosive"
    " abrasive adhesive preservative sedative laxative digestive derivative directive perspective collective"
    " handful spoonful armful mouthful"
    " table timetable vegetable cable constable stable bible crucible dirigible collectible turntable worktable fable"
    " variable wearable consumable disposable perishable edible convertible thurible"
    " negative positive digest cosy cozy sharp"
)
"""Nouns with such endings."""
_ADVERBS_NOT = word_set(
    "family jelly fly trolley lily belly butterfly assembly reply supply ply doily holly dolly brolly jolly ally"
    " curly woolly wooly early daily weekly friendly lovely silly ugly elderly monthly yearly living trolly gully"
    " barfly dragonfly sally polly rally folly tally billy filly willy chilly potbelly monopoly anomaly kelly"
    " only lonely likely holy homily wobbly bubbly frilly"
)
_THIRD_PERSONS = word_set(
    "adds represents symbolises symbolizes signifies ensures makes gives lets seems becomes consists encourages"
    " invites improves enhances defines anchors frames completes softens complements suits varies differs depends"
    " tends matters works brings draws guides leads invokes honours honors reflects means keeps"
)
"""Verbs in the third person that are not nouns, besides those that tell a place."""
_VERBS_OF_CLAUSES = _THIRD_PERSONS | {"includes", "contains", "requires", "creates"}
"""Verbs that no compound begins with."""
_ONLY_VERBS = word_set(
    "kneel sit lie belong remain include contain put create ensure represent symbolise symbolize provide require become"
    " allow prevent complete"
)
"""Verbs that are not the names of things, as *hold* and *keep* are."""
_SUGGESTING = word_set("suggest recommend advise prefer think")
"""Verbs of persons, which are not nouns."""
_PARTICIPLES = word_set(
    "placing putting positioning arranging attaching inserting connecting adding keeping leaving making using"
    " including having stuffing alternating filling storing grouping displaying organizing organising securing"
    " installing tucking"
)
"""Participles of clauses, which are not the first word of a name as those of *folding chair* are."""
_VERBAL = ("bute", "tute", "cate", "nate", "rate", "ize", "ify", "duce", "clude", "scribe", "volve")
"""Endings of verbs, which stand after a plural in a clause."""
_OF_MEANS = frozenset({"using", "including", "having", "containing"})
"""Participles of clauses inside a run of words."""
_OF_CLAUSES = (
    DETERMINERS
    | POSSESSIVES.keys()
    | MODALS.keys()
    | word_set("once when while if because that which who then until not than enough")
) - word_set("a single only same other need no can")
"""Words that stand in a clause and not inside a name; *can* is a vessel too, and *panel A* a name."""


def can_have_a_place(noun: str, nouns: KnownNouns) -> bool:
    """Return True for a noun that can name a thing with a place.

    Parameters
    ----------
    noun
        Noun or compound in the singular, in lower case.
    nouns
        Nouns of the ontology. A noun that it knows names a thing.

    Returns
    -------
    bool
        False for a quality, an act, a time, a measure or a direction, and for words with a verb or an adverb among
        them, which are a piece of a clause.

    Examples
    --------
    >>> from deixis.grammar.english.vocabulary.known_nouns import known_nouns
    >>> from deixis.ontology.tbox import default_ontology
    >>> nouns = known_nouns(default_ontology().kinds)
    >>> [can_have_a_place(noun, nouns) for noun in ("censer", "wine glass", "eye level", "moss layer adds", "left")]
    [True, True, False, False, False]
    """
    if not noun or noun.startswith(LITERAL) or (nouns.knows(noun) and noun not in _SELDOM_THINGS):
        return True
    words = noun.split()
    if words[-1].isdigit():
        return True  # 'number 9'
    if _is_piece_of_clause(words, nouns):
        return False
    if len(words) > 1 and words[-1] == "thing":
        return False
    last = last_word(noun).rpartition("-")[2]  # 'eye-level'
    if last not in _WITHOUT_PLACE and nouns.knows(last):
        return True
    if last in _WITHOUT_PLACE:
        return len(words) > 1 and last in _KEPT
    return last in _CONCRETE or not last.endswith(_ENDINGS)


def _is_quality(word: str) -> bool:
    """Return True for a word with the form of an adjective: *expensive*, *scarcest*, *shorter*."""
    if word in _NOUNS_LIKE_QUALITIES:
        return False
    degree = adjectives().get(word) is not None and word.endswith(("er", "est"))
    return degree or word in QUALITIES or _is_superlative(word) or word.endswith(_QUALIFYING)


def _is_superlative(word: str) -> bool:
    """Return True for the superlative of a quality: *sharpest*, *simplest*, *driest*."""
    if not word.endswith("est"):
        return False
    stem = word.removesuffix("est")
    return not QUALITIES.isdisjoint((stem, f"{stem}e", stem[:-1], f"{stem[:-1]}y"))


def _is_piece_of_clause(words: list[str], nouns: KnownNouns) -> bool:
    """Return True for a compound with a verb, an adverb or a function word among its words."""
    if len(words) == 1:
        return not nouns.knows(words[0]) and (words[0] in _ONLY_VERBS | _VERBS_OF_CLAUSES or _is_quality(words[0]))
    if words[0] in _VERBS_OF_CLAUSES:
        return True
    at = words.index("can") if "can" in words[1:-1] else 0
    if at and not nouns.knows(words[at + 1]):
        return True  # 'rules can vary', not 'garbage can lid'
    if words[-1].endswith(_VERBAL) and not nouns.knows(words[-1]) and nouns.singular(words[-2])[1]:
        return True  # 'parts contribute'
    if not _OF_MEANS.isdisjoint(words[1:]):
        return True  # 'wall using nails'
    counted = words[0].endswith("ing") and not NUMBERS.keys().isdisjoint(words[1:-1])
    if words[0] in _PARTICIPLES or counted:  # 'placing lids', 'drilling two screws'
        return True
    for place, word in enumerate(words):
        form = verb_forms().get(word)
        third = (form is not None and form.form == "s") or word in _THIRD_PERSONS or word.endswith(("ifies", "izes"))
        third = third and place > 0 and not nouns.knows(word)
        adverb = word.endswith("ly") and len(word) > 4 and word not in _ADVERBS_NOT and not nouns.knows(word)
        if third or adverb or (place and word in _SUGGESTING) or word in _OF_CLAUSES or word in OTHER_UNITS & _TIMES:
            return True
    return False
