"""Reword questions about then and now: the same question in the words that the grammar has.

>>> plain_question("Can you tell me where the cup was half an hour ago?")
'where was the cup 0.5 hour ago'
"""

from __future__ import annotations

import re

from deixis.grammar.recall.acts import reworded

_NUMBERS = {
    name: str(number)
    for number, name in enumerate(("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"), 1)
} | {"a": "1", "an": "1", "half an": "0.5"}
_NUMBER_WORDS = "|".join(sorted(_NUMBERS, key=len, reverse=True))
_SEVERAL = "|".join(name for name, number in _NUMBERS.items() if float(number) > 1)
_COUNTED = re.compile(rf"\b({_NUMBER_WORDS}) (?=(?:second|minute|hour|day|week)s?\b)")

_HERE = r"(?:here|there|around|present|at (?:the|this|my|our) (?:table|desk)|in (?:the|this|my|our) (?:room|kitchen))"
_ANYONE = r"(?:(?:any|some) ?(?:one|body)|people)"
_TIMED = r"(?=$| since| before| after| at | in | between| when | until| today| yesterday| this | \d)"
_STATED = r"(?: (?:with|about|on|of|at|in) (?:the|this|my|our) (?:table|desk|setting))?"
_DONE_AS = {
    "come": "came", "arrive": "arrived", "appear": "appeared", "go": "went", "disappear": "disappeared",
    "vanish": "vanished", "leave": "left", "move": "moved",
}  # fmt: skip
"""Past tense of what things do by themselves."""

_WORD = rf"(?!(?:{'|'.join(_DONE_AS.values())}|was|were)\b)[\w-]+"
_NOUNS = rf"{_WORD}(?: {_WORD})*"
"""Words of a noun, which end before a verb."""

_REWORDED = tuple(
    (re.compile(pattern), wording)
    for pattern, wording in (
        (r" (?:at (?:the )?(?:moment|present)|right now|just now|currently|these days|as of now)\b", " now"),
        (r" (?:so far|at all|all in all|in total|altogether|by now)\b| ever\b(?! since)", ""),
        (r"^(?:how long ago|(?:at|on) (?:what|which) (?:time|date|day|moment)|what (?:time|date|day)|"
         r"when exactly)\b", "when"),
        (r"^(?:for how long|(?:un)?till? when|from when (?:on )?(?:to|(?:un)?till?) when)\b", "how long"),
        (r"^where (?:can|could|would|will|may|do) (?:i|we|one|you) (?:find|see)\b", "where is"),
        (r"^where (.+?) used to (?:be|stand|lie|sit)\b", r"where was \1 before"),
        (r"^(?:on )?(?:which|what) side of .+? (is|are|was|were) ((?:the|my|our) [\w-]+(?: [\w-]+)??)(?: on)?$",
         r"where \1 \2"),
        (r"^(is|are|was|were) ((?:the|my|our) [\w-]+(?: [\w-]+)??) ((?:to the |on the |in )?(?:left|right|"
         r"front)|behind|on|in|"
         r"under|near|next to|inside|above|below)\b.*? or (?:to the |on the |in )?(?:left|right|front|behind|on|"
         r"in|under|near|"
         r"next to|inside|above|below)\b.*$", r"where \1 \2"),
        (r"^(where|when|what|who) (?:exactly|precisely)\b", r"\1"),
        (r"^(what|who|which \w+) else\b", r"\1"),
        (r"^(is|are|was|were|did|has|have) not\b", r"\1"),
        (r"\bget (?:here|there|back)\b", "come"),
        (r"\b(?:has |have |did )?changed? (?:its|their) (?:place|position)s?\b", "was moved"),
        (r"^what (?:is|are) (?:still )?(?:left|remaining) (?=on\b)", "what is "),
        (r"^(?:list|name|enumerate|the) (?:me )?(?:everything|(?:all )?(?:of )?the (?:things|"
         r"objects))\b.*$", "what is there"),
        (r"^the names? of ([a-z]+\d+)$", r"what is \1"),
        (r"^how many (.+?) (?:do|can) you see\b", r"how many \1 are there"),
        (rf"^(is|are|was|were) there (?:{_SEVERAL}|\d+) (?!second|minute|hour|day|"
         rf"week)([\w -]+?s)\b",
         r"how many \2 \1 there"),
        (r"^since when (?:is|are|was|were|has|have) (.+?)(?: been)? there$", r"how long was \1 there"),
        (r"^when did (.+?) (?:point (?:at|to)|show (?:you|me)|name) (.+)$", r"when was \2 shown"),
        (r"^(?:what|which (?:names|words|things)) (?:did|have) you learn(?:ed|"
         r"t)? about ", "what did anyone say about "),
        (r"^what (?:is|was) the difference between (?:now and (.+)|(.+) and now)$",
         lambda found: f"what changed since {found[1] or found[2]}"),
        (r"^(?:did|have) you (?:see|seen|notice|noticed) (.+?) (?:being |get |get being |be )(moved|taken away|"
         r"put down|taken)\b",
         r"was \1 \2"),
        (r" by (noon|midnight|\d{1,2}(?::\d{2})?(?: ?[ap]m)?)$", r" before \1"),
        (r"^(?:has|have|did) (?:any|some) ?(?:one|body) seen? (.+)$", r"when did you last see \1"),
        (r"^(what|which [\w ]+?) (?:lies|stands|sits|rests)\b", r"\1 is"),
        (r"^where (?:has|have) ((?:the|my|our) (?:(?!been\b)[\w-]+ )+)been$", r"how long was \1there"),
        (r"^who (?:said|told (?:you|me|us)) (?:that )?(?:the|an?|"
         r"my) ([\w-]+) .+$", r"what did anyone say about the \1"),
        (r"^who (?:came|arrived|was (?:here|there)) (first|last) [\w -]+ or [\w -]+$", r"who was there \1"),
        (r"^how many (.+?) (?:are|is) (?:still )?left(?: over)?$", r"how many \1 are there"),
        (r"^(?:(?:since )?when|how long) (?:is|was|has|have|were) (?:some|any)thing (?:been )?wrong\b"
         r"|^when (?:was|were) (?:the|a|any) (?:mistake|fault|error)s? made\b", "what faults was there"),
        (r"^did (.+?) do (?:any|some)thing\b", r"what did \1 handle"),
        (r"^when (?:was|were) (.+?) last (?:seen )?(?:here|there|around|seen)\b", r"when did you last see \1"),
        (rf"^when did (.+?) (first|last) ({'|'.join(_DONE_AS)})\b", r"when did \1 \3 \2"),
        (r"^(?:if|whether) (.+?) (is|are|was|were|has|have) ", r"\2 \1 "),
        (r"^(.+?) (is|are|was|were) (.+?) (?:is|are|was|were|has|have) not (?:it|they|there)$", r"\2 \1 \3"),
        (r"^(?:has|have) (.+?) been (?=(?:on|in|under|left|right|near|next|behind|to the|there)\b)", r"was \1 "),
        (r"^where (?:was|were) (.+?) (?:moved|put|taken|brought) to$", r"where is \1"),
        (r"^where (?:(?:was|were) (.+?) (?:moved|taken|brought)|did (.+?) (?:come|move)) from$",
         lambda found: f"where was {found[1] or found[2]} before"),
        (r"^(?:is|are) (.+?) (?:still )?where (?:it|they) (?:was|were|stood|lay)\b.*$", r"how long was \1 there"),
        (r"^(?:is|are|was|were) (.+?) back(?: again)?(?: now)?$", r"did \1 come back"),
        (r"^(did .+?) returns?(?: again)?\b", r"\1 come back"),
        (r"^(?:do|can) you (?:still )?see ((?:an?|the|any|some|my|our) .+?)(?: now)?$", r"is \1 there now"),
        (r"^what an? ([\w ]+?) (?:is|means|looks like)$", r"who showed you the \1"),
        (r"^(?:what|which [\w ]+?) (is|are|was|were) (?:misplaced|displaced|out of place|in the wrong place|"
         r"not (?:where (?:it|they) (?:should|belongs?|ought)(?: to)?(?: be)?|in (?:its|their|"
         r"the right) places?|right|correct))\b",
         r"what faults \1 there"),
        (r"^(is|was) (?:any|some)thing (?:misplaced|displaced|out of place|in the wrong place|"
         r"not (?:in its place|right))\b",
         r"what faults \1 there"),
        (r"^(is|was) there (any|some)thing (new|missing|gone)\b", r"\1 \2thing \3"),
        (r"^how many changes (?:were|have been|are) (?:there|made)\b", "what changed"),
        (r"^how many (.+?) (?:did|have) you (?:see|seen)\b", r"how many \1 came"),
        (r"^(?:what about|(?:(?:tell|show) me )?(?:everything|all|what you know)(?: you (?:know|"
         r"remember))?(?: about)?) "
         r"(?=(?:the|my) )", "what happened about "),
        (r"^(?:describe|what do(?:es)?) (?:the|this|my|our) (?:table|desk)(?: look(?: like)?)?\b", "what is there"),
        (r"^(?:what|which) (?:names?|words?|things?) (?=did .+? (?:teach|show)|(?:has|have) .+? (?:taught|"
         r"shown))", "what "),
        (r"^(?:what|which) (?:names?|words?|things?|objects?|kinds?(?: of things)?) do you know\b", "what was shown"),
        (r"^(?:how (?:sure|certain|confident) are you|are you (?:sure|certain)|"
         r"how do you know)(?: that)? (.+?) (is|are|was|were) ",
         r"\2 \1 "),
        (r"^where did (.+?) (?:stand|lie|sit|stay|rest)\b", r"where was \1"),
        (r"^(where (?:is|are|was|were) (?!.*\bbetween\b).+?) and (?:the |my |our )", r"\1 or "),
        (r"^what (?:is|was) the (first|last|latest) (?:thing|event) (?:that |"
         r"to )?happen(?:ed)?\b", r"what happened \1"),
        (r"^(?:which|what)(?: one| thing| of them)? (came|went|appeared|vanished|arrived|disappeared|"
         r"(?:was|were|has been|have been) (?:moved|shown|put down|taken away)) (first|last|earlier|later) "
         r"(?:the |my )?([\w -]+?) or (?:the |my )?([\w -]+)$",
         lambda found: f"which {found[3]} or {found[4]} {found[1]} "
                       f"{ {'earlier': 'first', 'later': 'last'}.get(found[2], found[2]) }"),
        (rf"^(did (?:.+?) ({'|'.join(_DONE_AS)})(?: back| away)? (?:before|after) (?:the|an?) {_NOUNS})$",
         lambda found: f"{found[1]} {_DONE_AS[found[2]]}"),
        (rf"^((?:was|were|has|have) (?:.+?) ((?:been )?(?:moved|taken away|put down)) (?:before|after) (?:the|an?) "
         rf"{_NOUNS})$",
         lambda found: f"{found[1]} was {found[2].removeprefix('been ')}"),
        (r"^what (?:(?:has|have) (.+?) (?:said|mentioned)|(?!(?:was|is|were|has|have|did|you)\b)(.+?) (?:said|"
         r"told (?:you|me)))"
         r"(?: so far| to (?:you|me))?\b(?! (?:that|is|are|was|were)\b)",
         lambda found: f"what did {found[1] or found[2]} say"),
        (r"^what do you know$", "what was shown"),
        (rf"^did (.+?) (?:say|speak|talk|mention|tell (?:you|me|us))(?: (?:anything|something|a word))?"
         rf"(?: to (?:you|me|us|any ?(?:one|body)))?{_TIMED}", r"what did \1 say"),
        (r"^when (?:did|has|have) (.+?)( first| last)? (?:say|said|speak|spoken?|talk(?:ed)?)"
         r"(?: (?:any|some)thing)?(?: (?:to|with) (?:you|me|us))?( first| last)?$",
         lambda found: f"what did {found[1]} say{found[2] or found[3] or ''}"),
        (r"^what (?:did|have) you (?:answer|repl(?:y|ied)|respond|ask|tell)(?:ed)?(?: (?:me|us))?\b(?! that)",
         "what did the robot say"),
        (r"^when did you (?:first )?(?:learn|find out|get to know|hear)(?: about| of)?"
         r"(?: (?:the )?(?:name|word)s?(?: (?:for|of))?| what)? (.+?)(?: (?:is|are|was|means?|is called|"
         r"looks? like))?$",
         r"when was \1 shown first"),
        (r"^(who (?:taught|showed|told) you) (?:(?:about )?the (?:name|word)s?(?: (?:for|of))?|what|how) "
         r"(?:the |an? )?(.+?)(?: (?:is|are|was|means?|is called|looks? like))?$", r"\1 the \2"),
        (rf"^(?:what|which (?:names|words|things)) (?:did|have) you (?:just )?learn(?:ed|t)?(?: (?:from me|"
         rf"new))?{_TIMED}", "what was shown"),
        (r"^what (?:kind|sort|type) of (?:thing|object|item) (is|was)\b", r"what \1"),
        (r"^what (?:do|did|would) you call ([a-z]+\d+|(?:this|that|it)(?: one)?)$", r"what is \1"),
        (r"^what is (?:the )?name (?:of|for) ([a-z]+\d+)\b", r"what is \1"),
        (r"^what (is|are|was|were) ([a-z]+\d+)(?: called| named)?\b", r"what \1 called \2"),
        (r"^(?:which|what)(?: one| thing| object)?s? (?:of (?:the|these|those) \w+ )?(is|are|was|were) "
         r"(?:called |named )?((?:the|an?) (?!first|last)[\w -]+)$",
         r"which thing \1 called \2"),
        (r"^(is|was|are|were) ([a-z]+\d+) (?:really |still )?(?:an?|the|called|named) (?:an? |the )?",
         r"\1 \2 called "),
        (rf"^(?:what|which) (?:layout|arrangement|setting|kind of (?:table|setting|layout)|type of table) "
         rf"(?:(is|was|were|did|do) )?(?:you (?:see|recognise|recognize)|it|this|that|here|there|laid|on (?:the|"
         rf"this) table)?"
         rf"(?: (?:laid|set|here|there))?{_TIMED}",
         lambda found: f"what layout {'was' if found[1] in ('was', 'were', 'did') else 'is'} there"),
        (rf"^what (is|was) (?:the|this) (?:layout|arrangement|setting)(?: (?:of|on) (?:the|this) table)?"
         rf"(?: (?:called|named|like|here|there))?{_TIMED}", r"what layout \1 there"),
        (rf"^how (is|was) (?:the|this|that|my|our) (?:table|desk) (?:laid|set|arranged)(?: now)?{_TIMED}",
         r"what layout \1 there"),
        (r"^(?:what|which) (?:mistakes?|faults?|errors?) (is|are|was|were) (?:there|made)\b", r"what faults \1 there"),
        (rf"^what (is|was) wrong(?: (?:here|there))?{_STATED}\b", r"what faults \1 there"),
        (rf"^(is|was) (?:any|some)thing wrong(?: (?:here|there))?{_STATED}\b", r"what faults \1 there"),
        (rf"^(is|was) (?:everything|the table|all|it) (?:right|correct|fine|in order|in its place|laid (?:right|"
         rf"correctly)|"
         rf"correctly laid|complete|ok|okay){_STATED}\b", r"what faults \1 there"),
        (r"^(what|which [\w ]+?) (?:(?:has|have|had|was|were|is|are|did) (?:not|never)|never) (?:yet )?(?:been )?"
         r"(?:moved?|touched|shifted)\b", r"\1 was never moved"),
        (r"^(what|which [\w ]+?) (?:(?:has|have|had) )?(?:stayed|remained|stood still)"
         r"(?: (?:where (?:it|they) (?:was|were|is|are)|in (?:its|their|the same) places?|put|there))*"
         r"(?: (?:all (?:the time|along)|the (?:whole|entire) time|always))?\b", r"\1 was never moved"),
        (r"^(what|which [\w ]+?) (?:has|have|was|were) (?:been )?(?:always )?(?:been )?(?:here|there|on the table) "
         r"(?:all (?:the time|along)|the (?:whole|entire) time|from the (?:start|beginning)(?: on)?|throughout|"
         r"always)\b",
         r"\1 was always there"),
        (r"^(what|which [\w ]+?) (?:has|have|was|were) always (?:been )?(?:here|there|on the table)\b",
         r"\1 was always there"),
        (r"^(?:what|which) colou?r (is|are|was|were|has|have|did)\b", r"what colour \1"),
        (r"^where (?:had|has|have) (.+?) been\b", r"where was \1"),
        (r"^where (?:is|are|has|have) (.+?) (?:gone|went)\b(?: to\b)?", r"where did \1 go"),
        (r"^(?:since when|how long) (?:is|are|was|were|has|have) (.+?) (?:been )?where (?:it is|they are)(?: now)?$",
         r"where is \1"),
        (rf"^who is (?:now )?{_HERE}(?: (?:right )?now)?$", "who was there in the last 1 minute"),
        (rf"^who (?:was|were|has been|have been)(?: (?:just|still))? {_HERE}\b", "who was there"),
        (r"^(?:whom?|which (?:people|persons)) (?:did|have) you (?:see|seen|meet|met|hear|heard)\b", "who was there"),
        (rf"^(?:was|were|has|have) (?:{_ANYONE})(?: been)? {_HERE}\b", "who was there"),
        (rf"^how many (?:people|persons) (?:were|are|have been) {_HERE}\b", "how many people were there"),
        (r"^who (?:came|dropped|stopped)(?: (?:by|in|round|over|along|here))*"
         r"(?= (?:today|yesterday|since|before|after|at|in|between|this)\b|$)", "who was there"),
        (rf"^(?:any|some) ?(?:one|body) {_HERE}\b", "who was there"),
        (rf"^who was the (first|last)(?: one| person)? (?:to be )?{_HERE}$", r"who was there \1"),
        (r"^(?:is|are) ([\w ]+?)(?: still)? (?:here|around|present)(?: (?:right )?now)?$", r"is \1 there now"),
        (r"^(?:was|were|has|have|is|are) ([\w ]+?)(?: still)?(?: ever)?(?: been)? (?:here|around|present)\b",
         r"was \1 there"),
        (r"^(what|which [\w ]+?) (?:stood|lay|sat)\b", r"\1 was"),
        (r"^(where (?:is|are|was|were) .+?) (?:standing|lying|sitting|placed)\b", r"\1"),
        (r"^what (?:is|was) different(?: now)?\b", "what changed"),
        (r"^(?:when|how long) (?:was|were|has|have) ([\w ]+?)(?: been)? (?:here|around|present)\b",
         r"how long was \1 there"),
        (r"^who (?:spoke|talked|said (?:any|some)thing)(?: to you)?\b", "what did anyone say"),
        (r"^who did you (?:talk|speak|listen) (?:to|with)\b", "what did anyone say"),
        (r"^what (?:was|were) the (first|last) (?:thing|sentence|word)s? (?:that )?(.+?) (?:said|told you)\b",
         r"what did \2 say \1"),
        (r"^what (?:did|have) you (?:say|said)\b", "what did the robot say"),
        (r"^what (?:have|did) you (?:ever )?learn(?:ed|t)? from (.+)", r"what did \1 show you"),
        (r"^what (?:did|has|have) (.+?) (?:teach|taught) you\b", r"what did \1 show you"),
        (r"^(?:has|have|is|was|were) (.+?) always (?:been )?there\b", r"how long was \1 there"),
        (r"^did (.+?) (?:always )?(?:stay|remain)(?: (?:where (?:it|they) (?:was|were)|there|in (?:its|their) place))?"
         r"(?: all the time)?$", r"how long was \1 there"),
        (r"^(?:since when|how long) (?:is|are|was|were|has|have) (.+?)(?: been)? (?:gone|missing|away)\b",
         r"when did \1 go"),
        (r"^where do(?:es)? (.+?) (?:belong|live)\b|^where (?:is|are) (.+?) (?:usually |normally )?(?:kept|stored)\b",
         lambda found: f"what did anyone say about {found[1] or found[2]}"),
        (r"^where should (.+?) (?:be (?:put|kept|stored)|be|go|stand|lie)\b", r"what did anyone say about \1"),
        (r"^where did (.+?) end up\b", r"where did \1 go"),
        (r"^where (?:is|are) (?:everything|all (?:of )?the (?:things|objects))\b", "what is there"),
        (r"^(?:what|how) did (?:the|this|my|our) (?:table|desk) look(?: like)?\b", "what was there"),
        (r"^who (?:told|said)(?: (?:you|us|me|anything|something))* about\b", "what did anyone say about"),
        (r"^where did (.+?) used? to be\b", r"where was \1 before"),
        (r"\b(?:has|have) gone\b", "went"),
        (r"\b(?:has|have) come\b", "came"),
        (r"\b(?:has|have) (?=(?:left|disappeared|vanished|arrived|appeared|moved)\b)", ""),
        (r"^what have you been shown\b", "what was shown"),
        (r"^what (?:(?:was|has been) said|(?:have you been|were you) (?:told|taught)) about\b",
         "what did anyone say about"),
        (r"^(?:did|have|has) (.+?) (?:ever )?(?:mention(?:ed)?|talk(?:ed)? about|sa(?:y|id) anything about|"
         r"t(?:ell|old) (?:you|me|us) (?:anything )?about) ",
         r"what did \1 say about "),
        (r"^what do you (?:know|remember) about\b", "what did anyone say about"),
        (rf"^did {_ANYONE} (?:take|remove|clear)(?: away| off)? (.+?)(?=$| since| before| after| at| in| between)",
         r"was \1 taken away"),
        (rf"^what did {_ANYONE} (?:take|clear|remove)(?: away| off)?\b", "what was taken away"),
        (rf"^did {_ANYONE} (?:move|shift|push)\b (.+?)(?=$| since| before| after| at| in| between)", r"was \1 moved"),
        (rf"^what did {_ANYONE} move\b", "what was moved"),
        (rf"^what did {_ANYONE} (?:(?:put|lay|set) down|bring|add)\b", "what was put down"),
        (r"\b(?:most recently|lastly)\b", "last"),
        (r"^what (?:is|was) the (first|last|latest) (?:thing|object|one) (?:that |which )?"
         r"((?:was |has been )?(?:moved|removed|taken away|put down|placed|added|shown)|came|went|appeared|vanished)\b",
         lambda found: f"what {found[2].replace('has been', 'was')} {found[1]}"),
        (r"\blatest\b", "last"),
        (rf"^(what (?:came|appeared)) (after|before) ((?:the|an?) {_NOUNS})$",
         r"\1 \2 \3 came"),
        (r"^what (?:do|can) you see\b", "what is there"),
        (r"^(what|which [\w ]+?) (?:did|have) you (?:see|seen)\b(?! yet)", r"\1 came"),
        (rf"^(?:did|have) you (?:ever )?(?:see|seen) (.+?){_TIMED}", r"did \1 come"),
        (r"^when did you first see (.+)$", r"when did \1 come first"),
        (r"^(where|when) (?:have|did) you (?:last (?:see|seen) (.+)|(?:see|seen) (.+) last)$",
         lambda found: f"{found[1]} did you last see {found[2] or found[3]}"),
        (r"^when (was|were) (.+) there$", r"how long \1 \2 there"),
        (r"^(?:has|did) (?:any|some)thing (?:changed?|happen(?:ed)?)\b(?! to)", "what changed"),
        (r"^(?:has|did) (?:any|some)thing happen(?:ed)? to ", "what happened about "),
        (r"^what (?:(?:has |had )?(?:happened (?:to|with)|become of)|became of) ", "what happened about "),
        (r"^what (?:is|has|was) (?:been )?(?:going on|happening)\b|^what went on\b", "what happened"),
    )
)  # fmt: skip
"""Wordings that ask for the same as others, each a pattern and its replacement."""

_HOURS = ["one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]
_PARTS = {"quarter": 15, "a quarter": 15, "half": 30, "five": 5, "ten": 10, "twenty": 20, "twenty five": 25}
_SPOKEN = re.compile(
    rf"\b(?:({'|'.join(sorted(_PARTS, key=len, reverse=True))}) (?:minutes )?(past|to) )?({'|'.join(_HOURS)}|\d{{1,2}})"
    r"(?: (o'clock|oclock))?\b"
)


def _spoken_time(found: re.Match[str]) -> str:
    """Return a spoken time of day in digits: *half past eleven* as 11:30; a plain number remains unchanged."""
    part, side, hour, o_clock = found.groups()
    if part is None and o_clock is None:
        return found[0]
    hours = int(hour) if hour.isdigit() else _HOURS.index(hour) + 1
    minutes = 60 * hours + (_PARTS[part] * (1 if side == "past" else -1) if part else 0)
    return f"{minutes // 60}:{minutes % 60:02d}"


_PREFACE = re.compile(
    r"^\s*((please|hey|hi|hello|so|now|and|well|ok|okay|excuse me|((can|could|would|will) you (please )?)?(tell|"
    r"show) me|"
    r"do you (know|remember|recall)|(did|have) you noticed?|can you (remember|say)|any idea|"
    r"i (want|would like|'d like) to know|i wonder)\s+)+(?=(where|what|which|who|when|since|how|if|whether|is|"
    r"are|was|were|"
    r"did|has|have|on|at|in|for|from|until|do|does|by|everything|all|describe|the name)\b)"
)
"""Words before a question that do not belong to it."""

_INDIRECT = re.compile(
    r"^(where|when|since when|how long) ((?:the|my|our|this|that|your) .+?|\w+) (is|are|was|were|has|have)\b(.*)$"
)
"""Question in the word order of a clause, as it comes after a preface: *(tell me) where the cup was at noon*."""


def plain_question(text: str) -> str:
    """Return a question in the words that the grammar has, without punctuation, prefaces and contractions.

    Parameters
    ----------
    text
        The question.

    Returns
    -------
    str
        The question in lower case, with numbers written as digits.
    """
    plain = text.lower().replace("\u2019", "'").replace("which ones", "which one")
    plain = re.sub(r"\b(where|what|who|when|it|that|there)'s\b", r"\1 is", plain)
    plain = re.sub(r"\b(is|are|was|were|has|have|did|do|does)n't\b", r"\1 not", plain)
    plain = re.sub(r"\b(have|has|did|were|was|are|is) you not\b|\b(have|has) not you\b", r"you \1\2 not", plain)
    plain = re.sub(r"\b(have|has) (i|we) told\b", r"did \2 tell", plain)
    plain = re.sub(r"[?!,;\"]|\.(?=\s|$)", " ", plain)
    plain = re.sub(r"\b(a|p)\.m\.?(?=\s|$)", r"\1m", plain)
    bare = _PREFACE.sub("", plain)
    plain = bare if bare == plain else _INDIRECT.sub(_in_order_of_questions, bare)
    plain = re.sub(r"\bwhich (?=did\b)|\bwhich (one )?of (them|these|those)\b", "which one ", plain)
    plain = re.sub(r"\s+please\s*$", "", plain.replace("how many times", "how often"))
    plain = reworded(_SPOKEN.sub(_spoken_time, " ".join(plain.split())))
    for pattern, wording in _REWORDED:
        plain = pattern.sub(wording, plain)
    plain = re.sub(r"\bstill\b|(?<=\w )here\b", "", plain)
    return " ".join(_COUNTED.sub(lambda found: f"{_NUMBERS[found[1]]} ", plain).split())


def _in_order_of_questions(found: re.Match[str]) -> str:
    """Return a clause that asks with its verb before its subject."""
    asked, subject, verb, rest = found.groups()
    is_verb_first = subject.split()[0] in ("is", "are", "was", "were", "did", "do", "does", "has", "have", "should")
    return found[0] if is_verb_first else f"{asked} {verb} {subject}{rest}"
