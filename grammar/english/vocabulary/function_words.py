"""Closed classes of English words: determiners, pronouns, numbers, units, auxiliaries, adverbs.

Nouns need no table: a word that is in none of the vocabulary's tables is a noun by its position.
"""

from __future__ import annotations

from deixis.grammar.english.vocabulary.tables import word_set

CHAT_WORDS = word_set("rn lol obvs tbh btw imo haha ugh omg idk lmao smh ikr yeah yep nope ah aha anyway")
"""Interjections of short messages, which stand anywhere."""

GREETINGS = CHAT_WORDS | word_set(
    "hi hello hey oh ok okay well yes thanks sorry welcome dear love good hmm um uh alright"
)

ARTICLES = frozenset({"a", "an", "the"})

DETERMINERS = word_set(
    "a an the this that these those each every all both no any some another other either neither same which what"
    " whichever several many few most only single"
)

POSSESSIVES = {
    "its": "it",
    "their": "they",
    "his": "he",
    "her": "she",
    "my": "me",
    "your": "you",
    "our": "we",
    "whose": "whose",
    "one's": "one",
}

PRONOUNS = {
    "it": "it",
    "itself": "it",
    "they": "they",
    "them": "they",
    "themselves": "they",
    "he": "he",
    "him": "he",
    "she": "she",
    "i": "me",
    "me": "me",
    "myself": "me",
    "you": "you",
    "yourself": "you",
    "yourselves": "you",
    "we": "we",
    "us": "we",
    "one": "one",
    "ones": "one",
    "each": "each",
    "both": "both",
    "all": "all",
    "either": "either",
    "neither": "neither",
    "none": "none",
    "nothing": "nothing",
    "nobody": "nothing",
    "everything": "everything",
    "anything": "anything",
    "something": "something",
    "someone": "someone",
    "somebody": "someone",
    "everyone": "everyone",
    "everybody": "everyone",
    "other": "other",
    "others": "other",
    "another": "other",
    "former": "former",
    "latter": "latter",
    "this": "this",
    "that": "this",
    "these": "these",
    "those": "these",
    "anyone": "someone",
    "anybody": "someone",
    "mine": "mine",
    "hers": "mine",
    "ours": "mine",
    "theirs": "mine",
    "yours": "yours",
    "who": "who",
    "what": "what",
    "which": "which",
    "whom": "which",
}


PERSONS = frozenset({"me", "you", "we", "he", "she", "they"})
"""Pronouns of persons, as values of ``PRONOUNS``."""

PLURAL_PRONOUNS = frozenset(
    {"they", "them", "themselves", "ones", "both", "all", "others", "these", "those", "we", "us"}
)

NUMBERS = {
    word: value
    for value, word in enumerate(
        [
            "one",
            "two",
            "three",
            "four",
            "five",
            "six",
            "seven",
            "eight",
            "nine",
            "ten",
            "eleven",
            "twelve",
            "thirteen",
            "fourteen",
            "fifteen",
            "sixteen",
            "seventeen",
            "eighteen",
            "nineteen",
            "twenty",
        ],
        start=1,
    )
} | {"dozen": 12, "couple": 2, "pair": 2}

ORDINALS = {
    word: value
    for value, word in enumerate(
        [
            "first",
            "second",
            "third",
            "fourth",
            "fifth",
            "sixth",
            "seventh",
            "eighth",
            "ninth",
            "tenth",
            "eleventh",
            "twelfth",
        ],
        start=1,
    )
} | {f"{n}{'st' if n == 1 else 'nd' if n == 2 else 'rd' if n == 3 else 'th'}": n for n in range(1, 13)}
ORDINALS |= {"last": -1, "final": -1, "1rst": 1}

UNITS = {
    "mm": 0.001,
    "millimetre": 0.001,
    "millimeter": 0.001,
    "cm": 0.01,
    "cms": 0.01,
    "centimetre": 0.01,
    "centimeter": 0.01,
    "m": 1.0,
    "metre": 1.0,
    "meter": 1.0,
    "inch": 0.0254,
    "inches": 0.0254,
    "foot": 0.3048,
    "feet": 0.3048,
    "ft": 0.3048,
    "yard": 0.9144,
    "yards": 0.9144,
    "handbreadth": 0.1,
    "finger": 0.02,
    "knuckle": 0.025,
    "hand": 0.1,
    "thumb": 0.02,
    "palm": 0.08,
    "fist": 0.1,
    "arm": 0.7,
    "stride": 0.8,
    "pace": 0.8,
}
"""Metres of a unit of length, by its singular and its irregular plurals."""

IS_FORMS = frozenset({"is", "are", "am", "'s", "'re", "'m", "be", "been", "being", "was", "were", "isn", "aren"})

PAST_FORMS = frozenset({"was", "were", "had", "did", "stood", "lay", "sat", "hung", "held", "kept", "faced", "leaned"})

MODALS = {
    "can": "can",
    "could": "could",
    "may": "may",
    "might": "might",
    "must": "must",
    "shall": "shall",
    "should": "should",
    "will": "will",
    "would": "would",
    "'ll": "will",
    "'d": "would",
    "ought": "ought",
    "need": "need",
    "needs": "need",
}

OTHER_UNITS = word_set(
    "a.m. p.m. a.m p.m am pm"
    " year years month months week weeks day days hour hours minute minutes second seconds kilo kilos kg gram grams g"
    " pound"
    " pounds litre litres liter liters ml percent euro euros dollar dollars times"
)
"""Units of other quantities than lengths."""

NEGATIONS = frozenset({"not", "n't", "never", "nor", "isnt", "arent"})

HEDGES = word_set(
    "about around roughly approximately approx almost nearly usually normally generally typically mostly often"
    " sometimes maybe perhaps possibly probably likely apparently seemingly presumably always rarely seldom hardly"
    " certainly definitely ideally preferably optionally"
)

APPROXIMATE = word_set("about around roughly approximately approx almost nearly")
"""Hedges of a number or a place, which leave no doubt that the thing is there."""

ADVERBS = word_set(
    "directly immediately right just slightly very quite rather really too so exactly precisely straight fairly pretty"
    " somewhat far much well also still already now currently actually again only even both either simply closely"
    " yesterday today tomorrow tonight afterwards recently meanwhile nowadays thereafter"
    " halfway midway partway mostly completely fully partially partly"
    " totally barely clearly diagonally vertically horizontally upright flat"
    " neatly carefully gently loosely tightly firmly evenly all up down back out off along there here"
    " together apart away nearby itself himself herself else instead please kindly basically kinda sorta obviously"
    " however therefore"
    " further farther close facedown freely freestanding separately individually alone solely lengthwise sideways"
    " widthwise breadthwise crosswise endwise edgewise lengthways widthways crossways edgeways endways slantwise"
    " crosswise squarely thus hence consequently accordingly"
    " dead bang smack slap ever least most more less super extremely overnight"
    " later soon finally twice thrice"
    " oftentimes ofttimes nonetheless nevertheless likewise moreover furthermore altogether henceforth hereafter"
    " sometime anyhow indeed thereby afterward beforehand presently meantime straightaway somehow forever regardless"
    " indoors outdoors upstairs downstairs abroad overall everytime"
)

READY = word_set("cool dry ready cold warm hot firm done full set finished complete assembled level straight")
"""Words for a thing with which a step is finished: *when cool, put it on the tray*."""

DEGREE_ADVERBS = word_set(
    "directly immediately right just slightly very quite rather really too so exactly precisely straight fairly pretty"
    " somewhat far much way well almost nearly partially partly completely fully diagonally vertically horizontally"
    " as about roughly approximately slight mostly even still all clearly kinda mainly only"
    " super extremely dead bang smack slap"
)

COLLECTIVES = word_set(
    "row line pair set group stack pile bunch couple number lot series column circle ring cluster collection dozen"
    " bundle trio array range kind type sort piece bit cup glass part majority rest"
)
"""Nouns whose *of* complement names the things: *a row of pawns*, *a pair of boots*."""

TYPOS = {
    "w/": "with", "w/o": "without",
    "teh": "the", "hte": "the", "th": "the", "thats": "that's", "isnt": "isn't", "arent": "aren't",
    "doesnt": "doesn't", "dont": "don't", "donn't": "don't", "wont": "won't", "cant": "can't", "hasnt": "hasn't",
    "wasnt": "wasn't", "theres": "there's", "closes": "closest", "closests": "closest", "closesest": "closest",
    "furtherst": "furthest", "betwen": "between", "beetween": "between", "inbetween": "between",
    "untop": "ontop", "nxt": "next", "infront": "in\u00a0front", "undr": "under", "rigth": "right", "rihgt": "right",
    "whith": "with", "wiht": "with", "wich": "which", "righthand": "right-hand", "lefthand": "left-hand",
    "youre": "you're", "midle": "middle", "conner": "corner", "cornor": "corner", "adn": "and", "nad": "and",
    "isto": "is\u00a0to", "ontop": "on\u00a0top", "ont": "on", "&": "and", "@": "at", "+": "and",
    "its'": "its", "nearset": "nearest", "closed-to": "close\u00a0to", "aother": "another", "ther": "there",
    "cuz": "because", "coz": "because", "bc": "because", "cos": "because",
    "underneat": "underneath", "directy": "directly", "opposit": "opposite", 
    "ot": "to", "fo": "of", "fro": "from", "frm": "from", "onn": "on",
}  # fmt: skip
"""Frequent misspellings of function words. A no-break space stands between the words that were written as one."""
