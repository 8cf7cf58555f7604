"""Verbs of what persons do with things, questions with these verbs, and sentences that tell who did what.

>>> told_act("Ben has taken the cup away.")
ToldAct(person='Ben', acts=('took',), thing='cup')
>>> reworded("was the fork moved by ada yesterday")
'did ada moved the fork yesterday'
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_VERBS = {
    r"puts?|putting|lays?|laid|laying|plac(?:es?|ed|ing)|sets?|setting|return(?:s|ed|ing)?|"
    r"drop(?:s|ped|ping)?": ("put", "moved"),
    r"brings?|brought|bringing|add(?:s|ed|ing)?|serv(?:es?|ed|ing)": ("put",),
    r"mov(?:es?|ed|ing)|shift(?:s|ed|ing)?|push(?:es|ed|ing)?|slid(?:es?|ing)?|displac(?:es?|ed|ing)|"
    r"drag(?:s|ged|ging)?": ("moved",),
    r"takes?|taken|taking|took|remov(?:es?|ed|ing)|clear(?:s|ed|ing)?|pick(?:s|ed|ing)?|grab(?:s|bed|bing)?|"
    r"steals?|stealing|stole|stolen|carr(?:y|ies|ied|ying)|fetch(?:es|ed|ing)?": ("took",),
    r"touch(?:es|ed|ing)?|handl(?:es?|ed|ing)": ("put", "moved", "took"),
}  # fmt: skip
"""Acts by the forms of the verbs that name them: ``put`` a new thing down, ``moved`` one, ``took`` one away."""

_VERB = f"(?:{'|'.join(_VERBS)})"
_PARTICLE = "(?:away|off|down|back|up|out|there|here)"
_WHEN = r"(?=$| (?:since|before|after|until|at|in|between|first|last|when|today|yesterday|this|just|\d))"
_THING = (
    r"(?:the|an?|my|your|our|his|her|their|this|that|these|those|some|any|all|both|it|them|"
    r"(?:any|some|every)thing)\b"
)

ACT_PATTERN = rf"{_VERB}(?: {_PARTICLE})*\b"
"""Pattern of a verb with its particles, which :func:`reworded` puts beside it."""


def act_terminals() -> dict[str, str]:
    """Return the patterns of the verbs by the names that they have in the grammar of questions.

    Returns
    -------
    dict
        Patterns of verbs with their particles: ``GONE``, ``PLACED``, ``MOVED`` and ``TOUCHED``.
    """
    put, brought, moved, took, touched = (f"(?:{forms})" for forms in _VERBS)
    away = r"(?: (?:away|off|out))"
    stays = r"(?! (?:away|off)\b)"
    return {
        "GONE": rf"(?:(?:{put}|{brought}|{moved}){away}|{took}(?: {_PARTICLE})*|gone|missing)\b",
        "PLACED": rf"(?:(?:{put}|{brought}){stays}(?: {_PARTICLE})*|new)\b",
        "MOVED": rf"{moved}{stays}(?: {_PARTICLE})*\b",
        "TOUCHED": rf"{touched}\b",
    }


@dataclass(frozen=True, slots=True)
class ToldAct:
    """Act that a sentence says a person did.

    Attributes
    ----------
    person
        The person in the words of the sentence; None for the one who speaks.
    acts
        What the person may have done: some of ``put``, ``moved`` and ``took``.
    thing
        Noun of the thing, without an article.
    """

    person: str | None
    acts: tuple[str, ...]
    thing: str


def acts_of(verb: str) -> tuple[str, ...]:
    """Return what a verb says that a person does with a thing.

    Parameters
    ----------
    verb
        A verb that :data:`ACT_PATTERN` matches, or a form of *leave*.

    Returns
    -------
    tuple of str
        Some of ``put``, ``moved`` and ``took``.

    Examples
    --------
    >>> acts_of("put down"), acts_of("put away"), acts_of("picked up")
    (('put', 'moved'), ('took',), ('took',))
    """
    word, *particles = verb.split()
    if {"away", "off"} & set(particles):
        return ("took",)
    return next((acts for forms, acts in _VERBS.items() if re.fullmatch(forms, word)), ("put", "moved"))


def reworded(question: str) -> str:
    """Return a question about who did what in the plain word order, with particles beside their verbs.

    Parameters
    ----------
    question
        The question in lower case, without punctuation.

    Returns
    -------
    str
        The question; unchanged if it is about something else.

    Examples
    --------
    >>> reworded("who was it that took the cup away"), reworded("what has ben put down")
    ('who took away the cup', 'what did ben put down')
    """
    for pattern, wording in _REWORDED:
        question = pattern.sub(wording, question)
    return question


def _active(found: re.Match[str]) -> str:
    """Return a passive question with its agent as an active one."""
    asked, thing, verb, person = (found[name] or "" for name in ("asked", "thing", "verb", "person"))
    if asked == "who":
        return " ".join(f"who {verb} {thing}".split())
    return " ".join(f"{asked} did {person} {verb} {thing}".split())


_REWORDED = tuple(
    (re.compile(pattern), wording)
    for pattern, wording in (
        (r"^what (?=(?:thing|object|one)s?\b)", "which "),
        (r",? and when(?: was (?:it|that))?$", ""),
        (rf"\b({_VERB}) (?:off|from) (?:the|this|my|our) (?:table|desk)\b", r"\1 away"),
        (rf"^(who {_VERB}) what$", r"\1 something"),
        (rf"^when was the (first|last) time (?:that )?(?:any|some) ?(?:one|body) ({_VERB}) (.+)$", r"who \2 \3 \1"),
        (rf"^when was the (first|last) time (?:that )?(.+?) ({_VERB}) (.+)$", r"when did \2 \3 \4 \1"),
        (r"^(?:who (?:was|is) it (?:who|that)|wh(?:ich|at) (?:person|one of (?:us|them))|whose hand)\b", "who"),
        (rf"^who (?:has|have|had|is|was)(?: just| been)* (?={_VERB}\b)", "who "),
        (rf"^who (?:is|was) responsible for (?={_VERB}\b)", "who "),
        (r"^(?:was|is) it [\w' -]+? or [\w' -]+? (?:who|that)\b", "who"),
        (rf"^how many (?:people|persons) (?:has |have )?(?={_VERB}\b)", "who "),
        (rf"^(?:was|is) it ((?:the |my )?[\w'-]+) (?:who|that) (?:has |have )?(?={_VERB}\b)", r"did \1 "),
        (rf"^when did (?:any|some) ?(?:one|body) (first|last) ({_VERB}) (.+)$", r"who \2 \3 \1"),
        (rf"^did (?!you\b)[\w ]+? ({_VERB}) (.+) or did [\w ]+$", r"who \1 \2"),
        (r" and (?:by whom|who (?:did it|was it|by))$", " by whom"),
        (rf"^(?:when|where) (?:was|were|has|have) (.+?)( first| last)?(?: been)? ({ACT_PATTERN}) by whom$",
         r"who \3 \1\2"),
        (rf"^who was the (first|last)(?: one| person)? (?:to|who|that) ({_VERB}) (.+)$", r"who \2 \3 \1"),
        (rf"^(who|what|which (?:\w+ )*?\w+) (first|last) ({_VERB}) (.+)$", r"\1 \3 \4 \2"),
        (rf"^what (?:is|was|were) the (first|last) (?:thing|one|object)s? (?:that )?"
         rf"(?!that |was |were |has |have )((?:\w+ )+?)({ACT_PATTERN})",
         r"what did \2\3 \1"),
        (rf"^(?:was|were|has|have) (.+?) (?:been )?({ACT_PATTERN}) by \w[\w ]* or (?:by )?\w[\w ]*$", r"who \2 \1"),
        (rf"^did (?!you\b)\w[\w ]*? or \w[\w ]*? ({_VERB}) (.+)$", r"who \1 \2"),
        (r"^(?:has|have|did) (?:any|some) ?(?:one|body) (?:ever )?(?=(?:touch|handl|us|push|grab|put|plac|set|"
         r"lay|laid|brought|bring)\w* )", "who "),
        (rf"^((?:what|when|where|how (?:many \w+|often)) |)(did|have|has) you (?={_VERB}\b)", r"\1\2 the robot "),
        (rf"^what (?:was|were|has been|have been) ({ACT_PATTERN}) by whom$", r"who \1 something"),
        (rf"^(who (?:{_VERB}) .+?) where (?:it|they) (?:is|are)(?: now)?$", r"\1 last"),
        (r"^what (?:did|have|has) (?:you see )?(.+?) (?:do|done) (?:to|with) (.+)", r"did \1 handle \2"),
        (r"^what (?:did|have|has|had) (?:you see )?(.+?) (?:do|done)\b", r"what did \1 handle"),
        (r"^what (?:is|was|were|are) (.+?) doing\b", r"what did \1 handle"),
        (r"^how often (?:was|were|has|have) (.+?) (?:been )?(?:touched|handled)\b", r"how often did anyone handle \1"),
        (r"^(?:is|are) (.+?) (?:still )?where (.+?) (?:put|laid|placed|left) (?:it|them)$", r"where did \2 put \1"),
        (r"^what (?:is|was|were) the (first|last) things? (?:that )?(.+?) (?:did|has done)$", r"what did \2 handle \1"),
        (r"^who did (?:what|(?:any|some)thing)\b", "who handled something"),
        (rf"^(where did .+? {_VERB} .+) to$", r"\1"),
        (rf"\b(was|were|been) (.+?) (first|last) ({ACT_PATTERN})$", r"\1 \2 \4 \3"),
        (rf"^by (?P<asked>who)m? (?:was|were|has|have) (?P<thing>.+?) (?:been )?(?P<verb>{ACT_PATTERN})(?P<person>)",
         _active),
        (rf"^(?P<asked>who)m? (?:was|were|has|have) (?P<thing>.+?) (?:been )?(?P<verb>{ACT_PATTERN}) by(?P<person>)\b",
         _active),
        (rf"^(?P<asked>what|which (?:\w+ )*?\w+|when|how often)? ?\b(?:was|were|has|have) "
         rf"(?P<thing>(?:\w+ )*?)(?:been )?(?P<verb>{ACT_PATTERN}) "
         rf"by (?!noon|midnight|now|then|\d)(?P<person>.+?){_WHEN}", _active),
        (rf"^(what |which (?:\w+ )+?|how many (?:\w+ )+?|)(?:has|have) (?!(?:been|changed|"
         rf"happened)\b)((?:\w+ )+?)(?<!been )"
         rf"(?=(?:{_VERB})\b)", r"\1did \2"),
        (rf"\b({_VERB}) ({_THING}(?: (?!{_PARTICLE}\b)[\w'-]+)*?) ({_PARTICLE})\b", r"\1 \3 \2"),
        (rf"\b({_VERB}) (?:just |already |actually |really )+", r"\1 "),
        (rf"\b(?:just|already|actually|really|ever) (?={_VERB}\b)", ""),
    )
)  # fmt: skip
"""Wordings of questions about who did what, each a pattern and its replacement."""

_TOLD = re.compile(
    rf"(?:(?P<self>i|we)(?:'ve)?|(?P<person>(?:(?:the|my|our|your) )?[^\W\d_][\w'-]*))"
    rf"(?: (?:has|have|had|just|already|also|then|now))* "
    rf"(?P<verb>(?:{_VERB})(?: {_PARTICLE})*) (?:the|an?|my|your|our|his|her|that|this) (?P<thing>[^\W\d_][\w' -]*?)"
    rf"(?: (?P<particle>away|off|down|back|up))?(?: (?:on|onto|in|into|to|from|beside|left|right|behind|next|near|"
    r"under|over|there|here|off|at|before|after|a|just|now|again|yesterday|today|this|because|so)\b.*)?",
)
"""Sentence that tells who did what with one thing."""

_PRESENT = re.compile(
    r"(?:puts|lays?|places?|sets|brings?|adds?|serves?|moves?|shifts?|pushes|takes?|removes?|clears?)$"
)


def told_act(text: str) -> ToldAct | None:
    """Return what a sentence says that a person did with a thing.

    Parameters
    ----------
    text
        One sentence in English, in the past tense: *I moved the fork*, *Ada has taken the cup away*.

    Returns
    -------
    ToldAct or None
        The act; None for another sentence.
    """
    plain = " ".join(re.sub(r"[.!]+$", "", text.strip().lower().replace("\u2019", "'")).split())
    found = _TOLD.fullmatch(plain)
    if found is None or _PRESENT.match(found["verb"]) or _NO_PERSON.match(found["person"] or ""):
        return None
    verb = found["verb"] if found["particle"] is None else f"{found['verb']} {found['particle']}"
    person = found["person"] and re.search(rf"\b{re.escape(found['person'])}\b", text, re.IGNORECASE)
    name = re.sub(r"^the ", "", person[0], flags=re.IGNORECASE) if person else None
    return ToldAct(name, acts_of(verb), found["thing"].strip())


_NO_PERSON = re.compile(
    r"(?:it|this|that|there|s?he|they|you|(?:no|some|any) ?(?:one|body)|who|what|which|please|not|never|then|first|now|"
    r"next|finally)$"
)
"""First words of sentences that do not name the person who acts."""
