"""Put the parsed clauses of a sentence together: subjects, viewpoints, conditions, alternatives, fragments."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from deixis.grammar.english.chunking.chunk import Chunk, VerbGroup
from deixis.grammar.english.clauses.build import flat, viewpoint_of
from deixis.grammar.english.clauses.built import ALONG_WITH, Built, Noun, Predication, Verb, misunderstood, notes
from deixis.grammar.english.clauses.joints import Segment
from deixis.grammar.english.clauses.places import HOURS
from deixis.grammar.english.clauses.predicates import place_left
from deixis.grammar.english.confidence import Guess
from deixis.grammar.english.sentences import RawSentence
from deixis.grammar.english.tree import Clause, Mood, NounPhrase, Predicate, Span, Viewpoint
from deixis.grammar.english.vocabulary.function_words import APPROXIMATE, HEDGES, IS_FORMS
from deixis.grammar.english.vocabulary.nouns import PEOPLE, last_word
from deixis.grammar.english.vocabulary.tables import word_set
from deixis.grammar.english.vocabulary.verbs import ENTER_VERBS, FACE_VERBS, PUT_VERBS, TRANSITIVE_RELATIONS

_PEOPLE = frozenset({"you", "me", "we", "someone"})
_REFERS_BACK = re.compile(r"\b(?:it|them|they|these|those)\b", re.IGNORECASE)
"""Pronouns that can stand for a thing of a condition."""
_ALTERNATIVE = re.compile(r"\bor\b", re.IGNORECASE)
_LAST_OF_ALL = re.compile(r"\b(?:finally|lastly|last\s+of\s+all)\b", re.IGNORECASE)
"""Words before the last step of several."""
_OWN = re.compile(r"\b(?:his|her)\b", re.IGNORECASE)
"""Owner of a part of the body: *he has a chip on his shoulder*."""
_FRAMES = frozenset({"facing", "from"})
_TREATING = word_set(
    "wash rinse soak wet dampen clean wipe scrub dry boil fry heat warm reheat bake roast cook cool chill mix beat"
    " whisk stir peel"
    " chop slice shake toast melt polish sharpen scour launder sanitize sanitise sterilize marinate mash mince dice"
    " poach saute simmer steam grill blanch braise baste knead blend dissolve thaw defrost freeze preheat whip puree"
    " grate carve drain dilute cleanse moisten knit sew iron"
)
"""Commands after which *in*, *under* and *with* tell how something is done: *wash the cups in the sink*.

After their object without an article, *on* does so as well: *chop onions on the board*.
"""
_BEING = frozenset({"be", "lie", "stand", "sit", "rest", "lay"})
"""Verbs before *off* and *out of* that say where a thing is not."""
_PLACING = frozenset(
    {
        "put", "place", "keep", "leave", "set", "lay", "store", "spread", "position", "move", "return", "transfer",
        "shift", "pour", "scatter", "sprinkle", "arrange", "drape", "stand", "hang", "hide", "tuck", "stash", "stick",
        "slip", "stow", "shove", "prop", "rest", "stack", "line", "drop", "slide", "push", "pile", "bury", "park",
        "tie", "clip", "pin", "hook", "squeeze", "balance", "lean", "insert", *PUT_VERBS,
    }
) - {"start", "finish", "turn", "top", "cover", "fill", "flank", "surround", "dot", "bring"}  # fmt: skip
_BEARING = frozenset({"hold", "contain", "carry", "bear"})
"""Verbs after whose object a place is that of the object."""
_GETTING = frozenset({"have", "get", "receive"})
"""Verbs by which each person has a thing at his place: *each guest gets a plate with …*."""
_HANDLING = frozenset(
    {
        "use", "need", "want", "serve", "finish", "open", "close", "take", "put", "move", "eat", "drink", "wash",
        "read", "write", "give", "get", "buy", "call", "make", "show", "set", "lay", "touch", "hold", "lift", "clean",
    }
)  # fmt: skip
"""Verbs of *when you … it*, which do not say where the viewer is."""
_TURNING = frozenset({"turn", "flip"})
_PLACES = frozenset({"left", "right", "middle", "top", "bottom", "part", "corner", "edge", "end", "side"})
_CONDITIONS = frozenset({"state", "other", "open", "closed", "empty"})
"""Properties that pass, of which *while* makes a condition."""
_UNDONE = frozenset({"almost", "nearly"})
_FALLING = frozenset({"fall", "drop", "tip", "slide", "slip", "roll"})
_FACTIVE = frozenset(
    {
        "see",
        "notice",
        "find",
        "know",
        "remember",
        "ensure",
        "mean",
        "discover",
        "observe",
        "realise",
        "realize",
        "require",
    }
)
"""Verbs after which a clause with *that* is a fact."""
_POINTS = frozenset(
    {"rule", "point", "fact", "result", "thing", "trick", "secret", "requirement", "difference", "advantage", "problem"}
)
"""Nouns of which *is that …* tells a fact: *the rule is that …*, not *the rumour is that …*."""
_ALLOWING = frozenset({"may", "can", "must", "should", "shall"})
"""Modal verbs that forbid with a subject such as *no one*: *no one may put a cup on it*."""
_DOUBTING = frozenset({"may", "might", "could", "would"})
"""Modal verbs of what need not be so."""
_LETTING = frozenset({"let", "make", "help", "watch"})
"""Verbs whose object does something itself: *don't let the cat sleep in it*."""
_MEETING = _GETTING | {"see", "find", "notice"}
"""Verbs by which a person says that a thing is there: *you see a cup on the left*."""
_OWNING = _MEETING | {"keep", "place", "put", "leave", "set", "lay", "stand", "hang", "store"}


@dataclass(slots=True)
class Found:
    """Result of a sentence: its clauses, or the noun phrase that it consists of, and the viewpoint."""

    clauses: tuple[Clause, ...]
    fragment: NounPhrase | None
    viewpoint: Viewpoint | None
    guesses: frozenset[Guess] = frozenset()  # of the fragment


@dataclass(slots=True)
class Assembly:
    """The clauses of one sentence while it is read."""

    text: str
    raw: RawSentence
    asks: bool
    clauses: list[Clause] = field(default_factory=list)
    fragments: list[NounPhrase] = field(default_factory=list)
    sought: NounPhrase | None = None  # 'choose the chair …'
    viewpoint: Viewpoint | None = None
    condition: str | None = None
    front: tuple[Predicate, ...] = ()  # places before a command: 'on the desk, choose the monitor'
    forbids: bool = False  # True after a command that is denied
    shared: tuple[Predicate, ...] = ()  # place before a list: 'in the box, put A on the left, B on the right'
    hedges: list[tuple[int, str]] = field(default_factory=list)  # adverbs that stand apart: 'perhaps the fork …'
    supposed: list[Clause] = field(default_factory=list)  # things of conditions: 'if there is ginger'
    named: list[NounPhrase] = field(default_factory=list)  # nouns of the clause that is put together
    opens_list: bool = False  # True if a colon follows the clause
    leads: bool = False  # True if a comma and a command follow: 'on it, stand the kettle'
    is_coordinated: bool = False  # True for a condition after *and*
    is_lost: bool = False  # True if the clause before has an object and was not understood
    borne: NounPhrase | None = None  # thing that the subject of the clause before holds
    guesses: frozenset[Guess] = frozenset()  # doubtful steps by which the clause that is being taken in was parsed
    guesses_of_fragments: dict[Span, frozenset[Guess]] = field(default_factory=dict)
    reported: VerbGroup | None = None  # verb of the main clause before the last *that*
    clock: NounPhrase | None = None  # 'if Z is the center of a clock face'

    def without_frame(self, segment: Segment) -> tuple[VerbGroup | None, Segment]:
        """Return the verb of a main clause such as *it could be that*, and the clause without it.

        Parameters
        ----------
        segment
            Clause that may have such a main clause before it.

        Returns
        -------
        tuple
            Verb of the main clause, or None if it has none, and the rest of the clause.
        """
        for i, chunk in enumerate(segment.chunks):
            if chunk.type == "COMPLEMENT":
                if isinstance(chunk.value, VerbGroup):
                    self.reported = chunk.value
                elif i or segment.link != "and":  # 'he says that A and that B' reports B too
                    self.reported = _frame_of_report(segment.chunks[:i])
                return self.reported, replace(segment, chunks=segment.chunks[i + 1 :])
        return None, segment

    def add(self, built: Built, link: str, start: int, end: int, hedge: VerbGroup | None) -> None:
        """Take in a parsed clause that stands after the joint ``link``.

        Parameters
        ----------
        built
            Parsed clause.
        link
            Joint before the clause, such as ``and`` or ``if``; empty for the first clause.
        start, end
            First and last character of the clause in the text, counted from 0, the end exclusive.
        hedge
            Verb of the main clause that the clause depends on (*it could be that*), or None.
        """
        span = (start, end)
        if hedge is not None and hedge.modal == "might" and built.shape not in ("statement", "existential", "inverted"):
            misunderstood(span, "this is only what a person says", "say where it is")
            return
        frame = self._frame(built, link, span)
        if frame is not None:
            self.viewpoint = _joined(self.viewpoint, frame)
            return
        if built.shape == "existential":
            built, looking = _looking(built, start)
            self.viewpoint = self.viewpoint if looking is None else _joined(self.viewpoint, looking)
        predications, fronted = _split_frames(built.predications)
        if fronted is not None:
            self.viewpoint = _joined(self.viewpoint, fronted)
            link = ""
        elif built.predications and link in ("when", "if", "while", "as"):
            frame = viewpoint_of(tuple(p for part in built.predications for p in part.predicates))
            if frame is not None:
                self.viewpoint, predications, link = _joined(self.viewpoint, frame), (), ""
        if link in ("before", "after") and built.shape == "statement":
            return
        last = self.clauses[-1] if self.clauses else None
        if link == "until" and last is not None and last.mood is Mood.COMMAND and last.positive:
            misunderstood(span, "this says how long something is done, not where it is")
            return  # 'press the foam into the bowl until it sits firmly'
        if link == "as" and built.subject is not None and built.subject.phrase.pronoun in _PEOPLE:
            return  # 'as you would expect'
        if link == "instead":
            misunderstood(span, "this says where something is not", "deny it: 'The cup is not on the tray.'")
            return
        if link == "if" and self._is_clock(built):
            return
        if link == "until" and self.clauses and not self.clauses[-1].past:
            return  # it holds now
        if link in ("whatever", "whichever"):
            return  # it holds in any case
        if link == "whether" and not self.clauses and _ALTERNATIVE.search(self.text[slice(*span)]):
            return  # 'whether the shelf is low or high, put the jar on it'
        if link == "in case" and self.clauses:
            return  # a reason: 'a copy is in the box in case the first is lost'
        if link == "while" and self.clauses and built.verbs and built.verbs[0].group.lemma == "be":
            verb_predicates = [p for verb in built.verbs for part in verb.predications for p in part.predicates]
            if verb_predicates and all(p.relation in _CONDITIONS and not p.arguments for p in verb_predicates):
                self._conditional(span, link)  # 'do not put it on the scale while it is hot'
                return
        if link in ("if", "unless", "when", "once", "until", "as", "whether", "whenever", "in case") and (
            built.verbs
            or (built.shape == "fragment" and not built.predications and link != "as")
            or (built.shape == "said" and link in ("unless", "whether"))
        ):
            self._conditional(span, link)
            subject = built.subject
            if subject is not None and subject.phrase.head and subject.phrase.determiner not in ("no", "any"):
                text = self._condition_text(span, link)
                self.supposed.append(Clause(replace(subject.phrase, predicates=()), (), span, condition=text))
            elif _REFERS_BACK.search(self.text, span[1], self.raw.end):  # 'if you use napkins, put them on the plate'
                text = self._condition_text(span, link)
                self.supposed += [
                    Clause(replace(one, predicates=()), (), span, condition=text) for one in self.named[:1]
                ]
            return
        if link == ":" and self.condition is not None and (self.clauses or self.fragments):
            self.condition = None  # 'when the guests arrive, the table looks like this: …'
        mood = self._mood(built)
        subject = built.subject
        if built.shape in ("command", "other"):
            group = built.verbs[0].group
            if link == "or" and self.forbids and group.positive:  # 'do not cover it or put it in a cupboard'
                group = replace(group, positive=False)
                built = replace(built, verbs=(replace(built.verbs[0], group=group), *built.verbs[1:]))
            self.forbids = not group.positive
            if built.shape == "other" and not group.positive and group.kind == "unknown":
                misunderstood(span, f"'{group.lemma}' does not say where something is not")
                return  # 'do not dip the bread in the oil'
        if built.shape == "other" and subject is not None and built.verbs[0].group.lemma in _TREATING:
            subject = _without_place_of_act(subject)
        letting = built.shape == "other" and built.verbs[0].group.lemma in _LETTING
        if built.shape == "other" and subject is not None and (not subject.phrase.predicates or letting):
            verb = built.verbs[0]
            misunderstood(span, f"'{verb.group.lemma}' does not say where something is")
            one = subject.phrase.pronoun == "one" and bool(subject.phrase.adjectives)
            if (subject.phrase.head or subject.phrase.members or one) and not letting:
                first, *_ = subject.phrase.members or (subject.phrase,)
                named = first.determiner == "the" or first.owner is not None
                handled = self.opens_list or (named and verb.group.positive)
                mood = Mood.COMMAND if handled else mood  # 'mind the saw: it …', 'wash the jug. it …'
                self._append(Clause(subject.phrase, (), span, mood, step=self.raw.step), link)
            return
        if built.shape in ("fragment", "search", "other"):
            self._fragment(built, subject, predications, link, span, mood)
            return
        if built.shape == "said" and subject is None and self.is_lost and link == "," and not built.verbs:
            misunderstood(span, "the clause that this belongs to is not understood")
            return
        if built.shape == "said" and subject is None:
            self._said(built, predications, link, span, mood)
            return
        if subject is None:
            return
        if subject.phrase.negated and not subject.phrase.members:
            misunderstood(span, "a denial of all does not say which", "say it of each of them")
            return
        past = link == "and" and bool(self.clauses) and self.clauses[-1].past
        verbs = built.verbs or (Verb(VerbGroup("be", "be", "finite", modal=self._doubt(link), past=past), (), span),)
        people = last_word(subject.phrase.head) in PEOPLE and all(
            v.group.lemma in _GETTING
            or (v.group.lemma in _MEETING and v.group.positive and (predications or v.predications))
            for v in verbs
        )
        own = subject.phrase.pronoun in ("he", "she") and not _OWN.search(self.text, *span)
        person = subject.phrase.pronoun in _PEOPLE or own or people
        known = len(self.clauses)
        held = verbs[-1].thing if verbs[-1].group.lemma in _BEARING else None
        self.borne = held.phrase if held is not None and held.phrase.head else None
        for i, verb in enumerate(verbs):
            front = predications if i == 0 else ()
            none = subject.phrase.pronoun in ("nothing", "none") or subject.phrase.determiner == "no"
            if none and subject.phrase.pronoun and subject.phrase.adjectives:
                misunderstood(span, "a denial of all things of a quality does not say which", "say it of each of them")
                continue
            if none and verb.thing is None and verb.group.kind in ("other", "unknown"):
                misunderstood(span, f"'{verb.group.lemma}' does not say where something is")
                continue
            acted = verb.group.lemma in _FALLING or (verb.group.kind in ("other", "unknown") and verb.thing is None)
            if acted and not _UNDONE.isdisjoint(verb.group.adverbs):
                misunderstood(span, f"'{verb.group.lemma}' did not happen here", "say where it is")
                continue
            departs = (
                verb.group.lemma == "leave"
                and verb.thing is not None
                and not front
                and not verb.predications
                and bool(subject.phrase.head)
            )
            if departs and last_word(subject.phrase.head) not in PEOPLE:
                misunderstood(span, "'leave' does not say where something is here")
                left = verb.thing.phrase if verb.thing is not None else None
                if left is not None and left.head and left.predicates:
                    self._append(Clause(replace(left, predicates=()), left.predicates, left.span), link)
                continue
            if verb.thing is not None and verb.group.lemma in _PLACING and not _UNDONE.isdisjoint(verb.group.adverbs):
                misunderstood(span, f"'{verb.group.lemma}' did not happen here", "say where it is")
                continue
            if verb.thing is not None and (
                verb.group.lemma in _PLACING
                or _turns_over(verb)
                or (person and verb.group.lemma in _OWNING)
                or (verb.group.lemma == "find" and verb.group.positive)
            ):
                kept = {"keep"} if subject.phrase.pronoun in ("me", "we") else {"leave", "keep"}
                placed = person and verb.group.lemma in _PLACING - kept and verb.group.past and not verb.group.modal
                if placed and " had " not in f" {self.text[slice(*verb.span)]} " and not self._was_undone(span):
                    verb = replace(verb, group=replace(verb.group, past=False))  # 'I stood the candle on the plate'
                if verb.group.lemma in _PLACING and _is_plan(verb.group, subject.phrase):
                    verb = replace(verb, group=replace(verb.group, modal="might"))
                moved, thing = self._of_the_thing(verb, subject)
                if none and moved.group.modal in _ALLOWING:
                    moved = replace(moved, group=replace(moved.group, modal="must", positive=False))
                elif none:
                    misunderstood(span, "a denial of all does not say where it is", "say where it is, or is not")
                    continue
                if not moved.predications and not front and verb.group.lemma not in _MEETING:
                    misunderstood(span, f"'{verb.group.lemma}' does not say where something is here")
                    continue
                meets = person and verb.group.lemma in _MEETING
                if meets and moved.group.modal == "can" and verb.group.lemma == "see" and not moved.group.positive:
                    misunderstood(span, "what cannot be seen may be there")
                    continue
                shape = "existential" if meets or verb.group.lemma == "find" else built.shape
                self._clause(shape, thing, moved, front, span, mood, hedge, link)
                continue
            self._clause(built.shape, subject, verb, front, span, mood, hedge, link if i == 0 else "and")
        objects = [v.thing.phrase for v in verbs if v.thing is not None and v.thing.phrase.head]
        acting = built.shape == "statement" and subject.phrase.pronoun in ("me", "we", "you")
        if acting and objects and len(self.clauses) == known:  # 'we use a lamp, and it hangs over the bar'
            made = replace(objects[-1], predicates=())
            self._append(Clause(made, (), span, Mood.COMMAND, step=self.raw.step), link)
        acted = built.shape == "statement" and bool(subject.phrase.head) and any(v.thing is not None for v in verbs)
        self.is_lost = acted and len(self.clauses) == known

    def finish(self) -> Found:
        """Return the clauses; a single noun phrase without a clause is the fragment of the sentence.

        Returns
        -------
        Found
            Clauses, fragment and viewpoint. What is left without a meaning is noted as misunderstood.
        """
        fragment = None
        rest = self.fragments
        if self.sought is not None:
            fragment = self.sought
        elif rest:
            fragment, *rest = rest
        for other in rest:
            if other.predicates:
                guesses = self.guesses_of_fragments.get(other.span, frozenset())
                bare = replace(other, predicates=())
                self.clauses.append(Clause(bare, other.predicates, other.span, guesses=guesses))
            elif not self._each_with_its_place(other, ",", Mood.STATEMENT):
                misunderstood(other.span, "nothing is said about this", "say where it is")
        if self.front:
            span = (self.front[0].span[0], self.front[-1].span[1])
            front, self.front = self.front, ()
            mood = Mood.QUESTION if self.asks else Mood.STATEMENT
            predicates, absolute = _absolutes(list(front))
            self._append(Clause(None, tuple(predicates), span, mood, step=self.raw.step), "")
            for noun, places in absolute:
                self._append(Clause(noun, places, span, mood, step=self.raw.step), "")
        if self.condition is not None and not self.clauses and fragment is None:
            start = self.raw.start
            misunderstood((start, self.raw.end), "a condition without what it is a condition of")
        if not self.clauses and fragment is None and self.viewpoint is None and not notes.get():
            misunderstood((self.raw.start, self.raw.end), "this says nothing about where a thing is")
        guesses = frozenset() if fragment is None else self.guesses_of_fragments.get(fragment.span, frozenset())
        return Found((*self.supposed, *self.clauses), fragment, self.viewpoint, guesses)

    # viewpoints and conditions

    def _frame(self, built: Built, link: str, span: Span) -> Viewpoint | None:
        """Return the viewpoint that a clause states and does nothing else: *if you are facing the bed*."""
        person = built.subject is not None and built.subject.phrase.pronoun in _PEOPLE
        predicates = [p for verb in built.verbs for part in verb.predications for p in part.predicates]
        predicates += [p for part in built.predications for p in part.predicates]
        if built.shape == "statement" and person:
            if link in ("if", "when", "while", "as", "once", "where") or any(p.relation in _FRAMES for p in predicates):
                entering = any(verb.group.lemma in ENTER_VERBS for verb in built.verbs)
                found = viewpoint_of(tuple(predicates))
                thing = next((verb.thing.phrase for verb in built.verbs if verb.thing is not None), None)
                seen = all(v.group.lemma not in _HANDLING and v.group.kind != "unknown" for v in built.verbs)
                if thing is not None and seen:
                    turned = any(verb.group.lemma in FACE_VERBS or verb.group.kind == "face" for verb in built.verbs)
                    found = found or Viewpoint(span)
                    found = replace(found, facing=thing) if turned else replace(found, at=found.at or thing)
                if found is None and entering and not predicates and (not self.clauses or link in ("as", "when")):
                    found = Viewpoint(span)  # 'as you come in'
                if found is not None:
                    return replace(found, span=span, entering=entering)
            return None
        subject = None if built.subject is None else built.subject.phrase
        if (
            subject is not None
            and subject.head == "back"
            and subject.owner is not None
            and subject.owner.pronoun in (*_PEOPLE, "one")
        ):
            behind = next((p.arguments[0] for p in predicates if p.arguments), subject.of)
            return None if behind is None else Viewpoint(span, back=behind)
        if built.shape == "said" and predicates and not built.verbs:
            framing = [p for p in predicates if p.relation in _FRAMES and p.subject_part is None]
            if (
                link in ("if", "when", "while", "as")
                or (framing and not self.clauses and not self.fragments)
                or (framing and predicates[0] is framing[0] and predicates[0].relation == "from")
            ):
                found = viewpoint_of(tuple(predicates))
                return None if found is None else replace(found, span=span)
        return None

    def _is_clock(self, built: Built) -> bool:
        """Take in *if Z is the center of a clock face*; the hours that follow are directions from Z."""
        kinds = [p.arguments[0] for verb in built.verbs for p in flat(verb) if p.relation == "kind"]
        if built.subject is None or not any(k.of is not None and k.of.head.startswith("clock") for k in kinds):
            return False
        self.clock = built.subject.phrase
        return True

    def _at_the_hour(self, predicate: Predicate) -> Predicate:
        """Return *between 4 and 5* and *at 3* as a direction from the centre of the clock, or a part of the region."""
        if predicate.value is not None and predicate.value.dimension == "clock" and not predicate.arguments:
            part = predicate.relation if "_" not in predicate.relation else None  # 'at 9 o'clock': on the left
            return replace(predicate, value=None, part=part)
        hours = [argument.count for argument in predicate.arguments if not argument.head]
        if self.clock is None or not hours or hours[0] is None or predicate.relation not in ("between", "at", "near"):
            return predicate
        relation = HOURS.get(hours[0] if len(hours) == 1 or hours[0] % 3 else hours[-1] or 0, "top")
        return replace(predicate, relation=relation, arguments=(self.clock,))

    def _condition_text(self, span: Span, link: str) -> str:
        """Return the words of a condition from its conjunction on, all of them: *if you want tea*."""
        start = self.text.casefold().rfind(link, self.raw.start, span[0])
        written = start >= 0 and not set(self.text[start : span[0]]) & set(",.;:")
        shown = self.text[start : span[1]] if written else f"{link} {self.text[slice(*span)]}"
        return " ".join([link, *shown[len(link) :].split()])

    def _conditional(self, span: Span, link: str) -> None:
        text = self._condition_text(span, link)
        found = notes.get()
        found[:] = [
            note for note in found if not span[0] <= note.span[0] < span[1]
        ]  # a condition need not be understood
        if self.clauses and self.clauses[-1].condition is None and not self.is_coordinated:
            self.clauses[-1] = replace(self.clauses[-1], condition=text)
        else:
            self.condition = text

    def _mood(self, built: Built) -> Mood:
        if self.asks or built.shape == "question":
            return Mood.QUESTION
        if built.shape in ("command", "search"):
            return Mood.COMMAND
        return Mood.STATEMENT

    # fragments

    def _fragment(
        self, built: Built, noun: Noun | None, predications: tuple[Predication, ...], link: str, span: Span, mood: Mood
    ) -> None:
        assert noun is not None
        phrase = noun.phrase
        if phrase.negated and not phrase.members and not phrase.head:
            misunderstood(span, "this says which things are not meant", "say it of the things that are meant")
            return  # 'the glasses on the shelf, not those by the till'
        if phrase.negated and phrase.head and self.clauses:
            denied = tuple(replace(p, positive=not p.positive) for p in phrase.predicates)
            phrase = replace(phrase, negated=False, predicates=denied)
        more = (*noun.extra, *(p for part in predications for p in part.predicates))
        if self.clauses and self.text[self.raw.start : span[0]].rstrip().casefold().endswith("because"):
            misunderstood(span, "a reason without a verb does not say where something is")
            return  # 'because the postman trips over it'
        if self.asks:
            mood = Mood.QUESTION
        if link == ":" and self._list(phrase, more, span):
            return
        listed = built.shape == "fragment" and (self.clauses or link == ":") and not phrase.predicates and not more
        if listed and mood is not Mood.QUESTION and self._each_with_its_place(phrase, link, mood):
            return
        if built.shape == "fragment" and (self.clauses or self.fragments or mood is Mood.QUESTION):
            predicates = (*more, *phrase.predicates)
            if predicates:
                bare = replace(phrase, predicates=())
                if self.clauses and self.clauses[-1].mood is Mood.COMMAND:
                    mood = Mood.COMMAND
                    if all(not p.arguments and p.relation in _PLACES for p in predicates[:1]):
                        predicates = (*self.shared, *predicates)
                self._append(Clause(bare, predicates, span, mood, modal=self._doubt(link), step=self.raw.step), link)
                return
            if self.clauses or phrase.pronoun in _PEOPLE:
                if phrase.head or phrase.adjectives or phrase.members:
                    misunderstood(phrase.span, "nothing is said about this", "say where it is")
                return
        more, self.front = (*self.front, *more), ()
        if more:
            phrase = replace(phrase, predicates=(*phrase.predicates, *more))
        if phrase.pronoun in _PEOPLE and not phrase.predicates:
            return
        if built.shape == "search" and self.sought is None:
            self.sought = phrase
            return
        self.fragments.append(phrase)
        self.guesses_of_fragments[phrase.span] = self.guesses

    def _doubt(self, link: str) -> str | None:
        """Return the modal verb that a clause without a verb shares: *A may be on the left and B on the right*."""
        last = self.clauses[-1] if self.clauses else None
        shares = last is not None and link in ("and", ",", ";") and last.positive and last.modal in _DOUBTING
        return last.modal if shares and last is not None else None

    def _each_with_its_place(self, phrase: NounPhrase, link: str, mood: Mood) -> bool:
        """Take in a list without verbs: *…, the knife on its right and the spoon beside the knife*.

        A member without a place shares that of the next member that has one.
        """
        if phrase.joined_by == "or" or not phrase.members or not phrase.members[-1].predicates:
            return False
        waiting: list[NounPhrase] = []
        for member in phrase.members:
            beside = any(a.pronoun == "it" and not a.head for p in member.predicates for a in p.arguments)
            if beside and waiting:  # 'a toaster, a kettle next to it'
                thing = replace(waiting[-1], determiner="the", count=None)
                made = tuple(
                    replace(p, arguments=tuple(thing if a.pronoun == "it" else a for a in p.arguments))
                    for p in member.predicates
                )
                for one in waiting:
                    self._append(Clause(one, (), one.span, mood, existential=True, step=self.raw.step), link)
                member, waiting = replace(member, predicates=made), []
            between = self.text[waiting[-1].span[1] : member.span[0]] if waiting else ""
            if member.predicates and _LAST_OF_ALL.search(between):  # 'the queen, the king, and finally a rook on it'
                for one in waiting:
                    self._append(Clause(one, (), one.span, mood, existential=True, step=self.raw.step), link)
                waiting = []
            waiting.append(replace(member, predicates=()))
            if not member.predicates:
                continue
            span = (waiting[0].span[0], member.span[1])
            subject = waiting[0] if len(waiting) == 1 else NounPhrase(span, plural=True, members=tuple(waiting))
            first = member.predicates[0]
            shared = self.shared if not first.arguments and first.relation in _PLACES else ()
            self._append(Clause(subject, (*shared, *member.predicates), span, mood, step=self.raw.step), link)
            waiting = []
        return True

    def _list(self, phrase: NounPhrase, more: tuple[Predicate, ...], span: Span) -> bool:
        """Take in a list after a colon: *from left to right: a cup, a jug*, *in front of it, a row: a cup, a jug*."""
        if self.front:
            shared, self.front = (*self.front, *more), ()
            self._append(Clause(phrase, shared, span, step=self.raw.step), ":")
            return True
        if self.fragments and [p.relation for p in self.fragments[-1].predicates] == ["row"]:
            shared = (*self.fragments.pop().predicates, *more)  # 'shelf, left to right: …'
            self._append(Clause(phrase, shared, span, step=self.raw.step), ":")
            return True
        if self.fragments and self.fragments[-1].head in ("row", "line", "circle", "list", "stack"):
            row = self.fragments.pop()
            relation = {"circle": "circle", "stack": "stacked"}.get(row.head, "row")
            predicates = [*row.predicates, *more]
            if not any(p.relation == relation for p in predicates):
                predicates.append(Predicate(relation, (), row.span))
            self._append(Clause(phrase, tuple(predicates), span, step=self.raw.step), ":")
            return True
        last = self.clauses[-1] if self.clauses else None
        if (
            last is not None
            and last.subject is not None
            and any(p.relation in ("row", "circle") for p in last.predicates)
        ):
            self.clauses[-1] = replace(
                last, subject=phrase, predicates=(*last.predicates, *more), span=(last.span[0], span[1])
            )
            return True
        if last is not None and (last.subject is None or (last.existential and last.subject.plural and not more)):
            if last.subject is None:
                self.clauses[-1] = replace(
                    last, subject=phrase, predicates=(*last.predicates, *more), span=(last.span[0], span[1])
                )
            else:
                kind = Predicate("kind", (phrase,), phrase.span)
                self.clauses[-1] = replace(last, predicates=(*last.predicates, kind), span=(last.span[0], span[1]))
            return True
        return False

    def _said(self, built: Built, predications: tuple[Predication, ...], link: str, span: Span, mood: Mood) -> None:
        """Take in predicates without a subject: they are said about the subject of the clause before."""
        last = self.clauses[-1] if self.clauses else None
        past = last is not None and last.past
        verbs = built.verbs or (Verb(VerbGroup("be", "be", "finite", past=past), (), span),)
        waits = last is None and self.sought is None and not self.fragments and not built.verbs
        waits = waits or (self.opens_list and not built.verbs)
        waits = waits or (self.leads and link in (";", "and", "then", "") and not built.verbs)
        if waits and not any(part.choice for part in predications):
            self.front += tuple(p for part in predications for p in part.predicates)
            return
        if last is None and self.sought is not None:
            predicates = tuple(p for part in predications for p in part.predicates) + tuple(
                p for v in verbs for p in flat(v)
            )
            self.sought = replace(self.sought, predicates=(*self.sought.predicates, *predicates))
            return
        if last is None and self.fragments:
            predicates = tuple(p for part in predications for p in part.predicates) + tuple(
                p for v in verbs for p in flat(v)
            )
            joined = self.fragments[-1]
            self.fragments[-1] = replace(joined, predicates=(*joined.predicates, *predicates))
            return
        subject = None if last is None else last.subject
        if self.borne is not None and link == "," and not built.verbs:
            subject = self.borne  # 'the shelf holds a lamp, in the middle'
        for verb in verbs:
            noun = None if subject is None else Noun(subject)
            self._clause("said", noun, verb, predications, span, mood, None, link)
            predications = ()

    # clauses

    def _was_undone(self, span: Span) -> bool:
        """Return True if a sentence in the past says when something was so, or what was done next."""
        words = self.text[self.raw.start : self.raw.end].casefold()
        return any(
            f" {word} " in f" {words} ".replace(",", " ") for word in ("yesterday", "ago", "last", "but", "until")
        )

    def _of_the_thing(self, verb: Verb, subject: Noun) -> tuple[Verb, Noun]:
        """Return *I have a lamp on the desk*, *you keep it under the mug* as a statement about the lamp."""
        thing = verb.thing
        assert thing is not None
        phrase = thing.phrase
        *before, last = phrase.members or (phrase,)
        shared = () if any(member.predicates for member in before) else last.predicates
        if not before and last.of is not None and last.of.predicates:  # 'he puts the cap of the jar on it'
            shared = (*last.of.predicates, *shared)
            phrase = replace(phrase, of=replace(last.of, predicates=()))
        if shared and before:  # 'I keep the jug and the bowl on a tray': both are on it
            phrase = replace(phrase, members=(*before, replace(last, predicates=())))
        elif shared:
            phrase = replace(phrase, predicates=())
        here = (*thing.extra, *shared)
        return replace(
            verb, thing=None, predications=(Predication(here), *verb.predications) if here else verb.predications
        ), Noun(phrase)

    def _clause(
        self, shape: str, subject: Noun | None, verb: Verb, front: tuple[Predication, ...], span: Span, mood: Mood,
        hedge: VerbGroup | None, link: str,
    ) -> None:  # fmt: skip
        group = verb.group
        phrase = None if subject is None else subject.phrase
        predicates = [p for part in front for p in part.predicates]
        extra = [] if subject is None else [*subject.extra]
        if (
            shape in ("question", "existential", "verbless", "inverted")
            and phrase is not None
            and not (predicates or extra)
            and not verb.predications
        ):
            predicates, phrase = [*phrase.predicates], replace(phrase, predicates=())
        if shape == "existential" and not group.positive and phrase is not None and not phrase.negated:
            phrase = replace(phrase, determiner="no") if phrase.head else phrase
            if phrase.pronoun in ("anything", "anyone", "one", "everything"):
                phrase = replace(phrase, pronoun="nothing")
            group = replace(group, positive=True)
        if phrase is not None and phrase.determiner == "neither" and (phrase.members or phrase.head):
            count = 2 if phrase.head else phrase.count  # 'neither lamp is on the desk'
            plain = replace(phrase, determiner="the" if phrase.head else None, count=count, plural=True)
            phrase, group = plain, replace(group, positive=not group.positive)
            verb = replace(verb, group=group)
        if not group.positive and shape not in ("question", "existential"):
            own = [p for part in verb.predications for p in part.predicates if p.relation != "there"]
            if not own:  # 'on the left, do not put the cup'
                predicates = [replace(p, positive=not p.positive) for p in predicates]
                self.front = tuple(replace(p, positive=not p.positive) for p in self.front)
            elif any(p.arguments or p.relation in _PLACES for p in own):
                predicates, self.front = [], ()  # 'on the left, it must not stand on the mat' denies the mat alone
        predicates += extra
        fronted = [p for p in (*predicates, *(q for part in verb.predications for q in part.predicates)) if p.arguments]
        if phrase is not None and fronted and shape in ("existential", "inverted", "verbless"):
            near = fronted[-1].arguments  # 'in front of the jug there is a cup, 15 cm away'
            with_places = tuple(
                replace(p, arguments=near) if p.measure is not None and not p.arguments and not p.part else p
                for p in phrase.predicates
            )
            phrase = replace(phrase, predicates=with_places)
        choices: list[tuple[Predicate, ...]] = []
        positive = group.positive
        main = flat(replace(verb, thing=None))
        denied = False
        for part in verb.predications:
            denied = (denied and part.choice) or any(not p.positive for p in part.predicates[-1:])
            if part.choice:
                chosen = (
                    part.predicates if positive else tuple(replace(p, positive=not p.positive) for p in part.predicates)
                )
                if positive and denied:  # 'behind the copier, not on it or in the sink'
                    main += tuple(replace(p, positive=not p.positive) for p in chosen)
                elif positive:
                    choices.append(chosen)
                else:  # 'not on the copier or in the sink' is neither
                    main += chosen
        if self.front and phrase is not None:
            self.shared = tuple(p for p in self.front if p.relation in ("inside", "on") and mood is Mood.COMMAND)
            predicates, self.front = [*self.front, *predicates], ()
        if mood is Mood.COMMAND:  # 'with a helper, turn the desk over'
            predicates = [p for p in predicates if p.relation != "with" or any(a.predicates for a in p.arguments)]
        if group.lemma in _BEING:
            main = [place_left(predicate) for predicate in main]  # 'the lid is off the pot'
        made, absolute = _absolutes(predicates + main)
        shared = tuple(p for p in made if p.relation != "with" and p.positive)
        if phrase is not None and shared:  # 'the gloves are on the shelf, along with the goggles'
            absolute += [(a, shared) for p in made if ALONG_WITH in p.adverbs for a in p.arguments]
            made = [p for p in made if ALONG_WITH not in p.adverbs]
        if verb.thing is not None:
            of_thing = flat(replace(verb, predications=(), nominal=None))
            if group.lemma not in TRANSITIVE_RELATIONS:  # 'I have opened it, with the lamp to my left'
                of_thing, more = _absolutes(of_thing)
                absolute = more + absolute
            made = of_thing + made
        hedges = tuple(a for a in group.adverbs if a in HEDGES)
        hedges += tuple(a for p in made for a in p.adverbs if a in HEDGES - APPROXIMATE and a not in hedges)
        before = [word for at, word in self.hedges if at < span[1]]
        self.hedges = [(at, word) for at, word in self.hedges if at >= span[1]]
        hedges += tuple(word for word in before if word not in hedges)
        modal = group.modal
        past = group.past
        if hedge is not None:
            modal = hedge.modal if hedge.modal == "might" else modal or hedge.modal
            past = past or hedge.past
            hedges += tuple(a for a in hedge.adverbs if a in HEDGES)
            if not hedge.positive:
                made = [replace(p, positive=not p.positive) for p in made]
        speaker = phrase is not None and phrase.pronoun in _PEOPLE
        handled = speaker and not made and positive and not choices and mood is Mood.STATEMENT
        if handled and verb.thing is not None and verb.thing.phrase.head and verb.thing.phrase.determiner == "the":
            thing = replace(verb.thing.phrase, predicates=())  # 'I love the clock. It hangs over the door.'
            added = self._added_about(verb.thing.phrase)
            self._append(Clause(thing, added, span, mood if added else Mood.COMMAND, step=self.raw.step), link)
        acts = group.kind in ("other", "unknown") and verb.thing is None and group.lemma not in _PLACING
        clause = Clause(
            phrase, tuple(made), span, mood,
            positive=positive or bool(made), modal=modal, hedges=hedges, past=past,
            guesses=frozenset({Guess.ACTION} if acts and shape == "statement" else ()),
            condition=self.condition, choices=tuple(choices), existential=shape == "existential", step=self.raw.step,
        )  # fmt: skip
        beside = [
            replace(clause, subject=noun, predicates=modifiers, choices=(), existential=False)
            for noun, modifiers in absolute
        ]
        first = 0
        while phrase is not None and first < len(absolute) and absolute[first][0].span[1] <= phrase.span[0]:
            self._append(beside[first], link)  # 'with the plate in front of you, lay the fork on its left'
            first += 1
        self._append(clause, "," if first else link)
        for other in beside[first:]:
            self._append(other, ",")

    def _added_about(self, phrase: NounPhrase) -> tuple[Predicate, ...]:
        """Return what a relative clause after a comma says: *I love the clock, which hangs over the door*."""
        predicates = phrase.predicates
        if not predicates or not self.text[self.raw.start : predicates[0].span[0]].rstrip().endswith(
            (", which", ", who")
        ):
            return ()
        return predicates

    def _append(self, clause: Clause, link: str) -> None:
        kept = []
        for predicate in map(self._at_the_hour, clause.predicates):
            if predicate.relation in ("through", "to", "measured_from") or (
                predicate.relation == "from" and predicate.measure is None
            ):
                misunderstood(predicate.span, "this does not say where something is")
            elif predicate.relation not in ("diagonal", "apart"):
                kept.append(predicate)
        if link == "or" and kept and self.clauses and clause.modal is None:  # 'leave it there or put it here'
            clause = replace(clause, modal="may")
            if self.clauses[-1].modal in (None, "can"):
                self.clauses[-1] = replace(self.clauses[-1], modal="may")
        named = clause.subject is not None and bool(clause.subject.head or clause.subject.members)
        handled = clause.mood is Mood.COMMAND and named
        placed = clause.subject is not None and bool(clause.subject.predicates)
        if kept or clause.choices or clause.existential or clause.mood is Mood.QUESTION or handled or placed:
            self.clauses.append(replace(clause, predicates=tuple(kept), guesses=self.guesses | clause.guesses))


def _without_place_of_act(noun: Noun) -> Noun:
    """Return the object of *wash the cups in the sink with soap* without where and with what that is done."""

    def bare(phrase: NounPhrase) -> NounPhrase:
        named = phrase.determiner is not None or phrase.owner is not None or phrase.pronoun is not None
        where = {"inside", "under", "above"} if named else {"inside", "under", "above", "on"}
        means = [
            p
            for p in phrase.predicates
            if p.relation == "with" and all(a.determiner in (None, "some", "more") and not a.owner for a in p.arguments)
        ]  # 'rinse the beaker with some water'
        kept = tuple(p for p in phrase.predicates if p.relation not in where and p not in means)
        for predicate in phrase.predicates:
            if predicate not in kept:
                misunderstood(predicate.span, Guess.ACTION.value)
        return replace(phrase, predicates=kept, members=tuple(map(bare, phrase.members)))

    return replace(noun, phrase=bare(noun.phrase))


def _is_plan(group: VerbGroup, agent: NounPhrase) -> bool:
    """Return True for *I'll put the cup on the tray*, which is not done yet, and *some people put it on the tray*."""
    others = agent.determiner in ("some", "other", "many", "most", "few") and bool(agent.head)
    return (group.modal == "will" and agent.pronoun != "you" and group.positive) or others


def _frame_of_report(before: tuple[Chunk, ...]) -> VerbGroup | None:
    """Return the verb of the main clause before *that*; only a few verbs and nouns make the clause after it a fact."""
    verbs = [c.value for c in before if isinstance(c.value, VerbGroup)]
    if not verbs:
        return None
    subjects = [c.value for c in before if c.type == "NP"]
    judged = any(c.type in ("PART", "ADJP") for c in before)
    if verbs[-1].lemma in IS_FORMS | {"be"} and not judged:
        known = not subjects or last_word(subjects[-1].head) in _POINTS or bool(subjects[-1].pronoun)
    else:
        known = verbs[-1].lemma in _FACTIVE and not judged
    return verbs[-1] if known else replace(verbs[-1], modal="might")


def _turns_over(verb: Verb) -> bool:
    """Return True for *I turned one jar upside down*."""
    predicates = [p for part in verb.predications for p in part.predicates]
    predicates += verb.thing.phrase.predicates if verb.thing is not None else ()
    return verb.group.lemma in _TURNING and any(p.relation == "upside_down" for p in predicates)


def _absolutes(predicates: list[Predicate]) -> tuple[list[Predicate], list[tuple[NounPhrase, tuple[Predicate, ...]]]]:
    """Separate *with G on the right* from what is said about the subject: it says where G is."""
    kept, absolute = [], []
    for predicate in predicates:
        phrase = predicate.arguments[0] if predicate.relation == "with" and predicate.arguments else None
        if phrase is not None and phrase.predicates and predicate.positive and predicate.subject_part is None:
            absolute.append((replace(phrase, predicates=()), _with_own_aims(phrase.predicates)))
        else:
            kept.append(predicate)
    return kept, absolute


def _with_own_aims(predicates: tuple[Predicate, ...]) -> tuple[Predicate, ...]:
    """Return *on top of the fork facing left*, with the aim as that of the spoon on it."""
    last = predicates[-1]
    if len(last.arguments) != 1 or last.relation not in ("on", "above", "next_to", "under") or last.reversed:
        return predicates
    thing = last.arguments[0]
    aims = tuple(p for p in thing.predicates if p.relation in ("facing", "pointing") and not p.arguments)
    if not aims or len(aims) != len(thing.predicates) or thing.determiner != "the":
        return predicates
    bare = replace(thing, predicates=(), span=(thing.span[0], max(thing.span[0], aims[0].span[0])))
    return (*predicates[:-1], replace(last, arguments=(bare,)), *aims)


def _looking(built: Built, start: int) -> tuple[Built, Viewpoint | None]:
    """Separate the viewpoint before *there is*: *looking towards the door, there are two closets*."""
    verb = built.verbs[0]
    first = verb.predications[0].predicates if verb.predications else ()
    if not first or first[0].span[0] > start or first[0].relation not in _FRAMES:
        return built, None
    return replace(built, verbs=(replace(verb, predications=verb.predications[1:]), *built.verbs[1:])), viewpoint_of(
        first
    )


def _split_frames(predications: tuple[Predication, ...]) -> tuple[tuple[Predication, ...], Viewpoint | None]:
    """Separate the viewpoint from what stands before a clause: *facing the window*, *from the door*."""
    top = [p for part in predications for p in part.predicates]
    nested = [q for p in top for argument in p.arguments for q in argument.predicates if q.relation == "facing"]
    seen_from = any(adverb.startswith("from ") for p in top[:1] for adverb in p.adverbs)  # 'from behind the desk, …'
    if not nested and not seen_from and not any(p.relation in _FRAMES and p.subject_part is None for p in top):
        return predications, None
    everything = tuple(p for part in predications for p in part.predicates)
    viewpoint = viewpoint_of(everything)
    return (predications if viewpoint is None else ()), viewpoint  # 'the cup is on the mat, facing left' has none


def _joined(first: Viewpoint | None, second: Viewpoint) -> Viewpoint:
    if first is None:
        return second
    return Viewpoint(
        (min(first.span[0], second.span[0]), max(first.span[1], second.span[1])), at=second.at or first.at,
        facing=second.facing or first.facing, back=second.back or first.back, own=second.own or first.own,
        entering=first.entering or second.entering,
    )  # fmt: skip
