"""Build the tree of a clause while the parser runs: one method per rule of ``english.lark``."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

from lark import Transformer, v_args

from deixis.grammar.english.chunking.chunk import Chunk, Relator, VerbGroup
from deixis.grammar.english.clauses.built import ALONG_WITH, Built, Noun, Predication, Verb, misunderstood, union
from deixis.grammar.english.clauses.places import arrangement_of, directions_of, is_place, other_side, place
from deixis.grammar.english.clauses.predicates import (
    AWAY_FROM,
    DIRECTION_RELATIONS,
    MOVING,
    WRAPPING,
    accompanied_by,
    arguments_of,
    by_means,
    checked,
    destination,
    merged,
    moved,
    transitive,
    with_support,
)
from deixis.grammar.english.tree import (
    TOWARDS,
    Adjective,
    Degree,
    Measure,
    NounPhrase,
    Predicate,
    Span,
    Viewpoint,
    aimed,
)
from deixis.grammar.english.vocabulary.adjectives import COMPARISONS
from deixis.grammar.english.vocabulary.function_words import PERSONS
from deixis.grammar.english.vocabulary.nouns import (
    AIMED_PARTS,
    FRONTS,
    GAPS,
    HOLDERS,
    PARTS,
    SUBSTANCES,
    SURFACES,
    VESSELS,
    last_word,
)
from deixis.grammar.english.vocabulary.relation_words import (
    ARRANGEMENTS,
    CIRCUMSTANCES,
    DEGREES,
    DIRECTION_WORDS,
    NEVER_PLACES,
    NOT_PLACES,
    PLACE_NOUNS,
    prepositions,
)
from deixis.grammar.english.vocabulary.tables import word_set


@v_args(inline=True)
class Builder(Transformer[Any, Built]):
    """Transformer with one method per rule of the grammar."""

    # clauses

    def fragment(self, top: Noun) -> Built:
        """Return a sentence that is only a noun phrase."""
        return Built("fragment", top, ())

    def statement(self, top: Noun, verbs: tuple[Verb, ...]) -> Built:
        """Return a subject with its verbs."""
        return Built("statement", top, verbs)

    def inverted(
        self, predications: tuple[Predication, ...], verb: Chunk, more: tuple[Predicate, ...] | None, top: Noun
    ) -> Built:
        """Return *to the left of the plate lies the fork*."""
        if more:
            predications = (*predications, Predication(more))
        if verb.type == "VERB":
            predications = moved(verb.value, predications, verb.span)
        return Built("inverted", top, (Verb(verb.value, predications, verb.span),))

    def verbless(self, predications: tuple[Predication, ...], top: Noun) -> Built:
        """Return *next to it a small cactus*."""
        return Built("verbless", top, (), predications)

    def existential(
        self,
        before: tuple[Predication, ...] | None,
        there: Chunk,
        be: Chunk,
        top: Noun | None,
        after: tuple[Predication, ...] | None,
    ) -> Built:
        """Return *there is a cup on the tray*."""
        return Built("existential", top, (Verb(be.value, (*(before or ()), *(after or ())), be.span),))

    def command(self, put: Chunk, raws: Noun, predications: tuple[Predication, ...] | None) -> Built:
        """Return *put the cup on the tray*."""
        group: VerbGroup = put.value
        if group.kind not in ("posture", "lean", "face", "point"):
            group = replace(group, kind="posture")
        if group.lemma == "surround" and predications:
            predications = tuple(
                replace(
                    part,
                    predicates=tuple(
                        replace(p, relation="around", reversed=True) if p.relation == "with" else p
                        for p in part.predicates
                    ),
                )
                for part in predications
            )
        predications = _with_contents(raws.phrase, predications)
        if predications and (group.lemma in WRAPPING or group.lemma in _FASTENING):
            predications = tuple(
                replace(part, predicates=by_means(group.lemma, raws.phrase, part.predicates)) for part in predications
            )
        if group.lemma in MOVING and predications:
            predications = tuple(
                replace(
                    part,
                    predicates=tuple(destination(p) for p in part.predicates),
                )
                for part in predications
            )
        predications = with_support(group, _against_supports(group.lemma, predications or ()))
        return Built(
            "command", raws, (Verb(group, moved(group, predications, put.span) if predications else (), put.span),)
        )

    def other(self, do: Chunk, top: Noun) -> Built:
        """Return a command that does not put anything anywhere: *open the box on the tray*."""
        return Built("other", top, (Verb(do.value, (), do.span),))

    def search(self, find: Chunk, top: Noun) -> Built:
        """Return *choose the chair next to the door*."""
        return Built("search", top, (Verb(find.value, (), find.span),))

    def whether(self, be: Chunk, top: Noun, predications: tuple[Predication, ...] | None) -> Built:
        """Return *is the knife to the left of the fork*."""
        return Built("question", top, (Verb(be.value, predications or (), be.span),))

    def asked(self, be: Chunk, top: Noun, verbs: tuple[Verb, ...]) -> Built:
        """Return *can the cup be on the tray*."""
        return Built("question", top, verbs)

    def whether_there(self, be: Chunk, there: Chunk, top: Noun) -> Built:
        """Return *is there a cup on the tray*."""
        return Built("question", top, (Verb(be.value, (), be.span),))

    def where(self, where: Chunk, be: Chunk, top: Noun, predications: tuple[Predication, ...] | None) -> Built:
        """Return *where is the fork*."""
        return Built("question", top, (Verb(be.value, predications or (), be.span),))

    def fronted(self, predications: tuple[Predication, ...], joint: Chunk, clause: Built) -> Built:
        """Return a clause with what stands before its comma: *in the corner, a lamp*."""
        return replace(clause, predications=(*predications, *clause.predications))

    def fronted_statement(self, predications: tuple[Predication, ...], clause: Built) -> Built:
        """Return *in the corner I have a lamp*."""
        return replace(clause, predications=(*predications, *clause.predications))

    def said(self, content: Any) -> Built:
        """Return predicates without a subject."""
        if content and isinstance(content[0], Verb):
            return Built("said", None, content)
        return Built("said", None, (), content)

    def verbs(self, *parts: Any) -> tuple[Verb, ...]:
        """Return the verb groups of one subject."""
        return tuple(part for part in parts if isinstance(part, Verb))

    def verb(self, *parts: Any) -> Verb:
        """Return a verb group with its complement and its predicates."""
        chunk = parts[0]
        group: VerbGroup = chunk.value
        if chunk.type == "BE":
            _, nominal, predications = parts
            noun = nominal
            shown = predications or ()
            if noun is not None and noun.extra and noun.phrase.head not in ("area", "part", "section", "spot", "place"):
                shown = (Predication(noun.extra), *shown)
            return Verb(group, shown, chunk.span, noun)
        if chunk.type == "VERB":
            predications = moved(group, with_support(group, parts[1] or ()), chunk.span)
            return Verb(group, predications, chunk.span)
        _, things, predications = parts
        if group.lemma in MOVING and predications:
            predications = tuple(
                replace(part, predicates=tuple(map(destination, part.predicates))) for part in predications
            )
        if group.lemma in MOVING:
            thing = replace(things.phrase, predicates=tuple(map(destination, things.phrase.predicates)))
            things = Noun(thing, tuple(map(destination, things.extra)))
        return Verb(group, predications or (), chunk.span, thing=things)

    def nominal(self, nps: Noun, *joined: Any) -> Noun:
        """Return the noun phrase after *is* or after a transitive verb."""
        return self.top(nps, *joined)

    # noun phrases

    def top(self, nps: Noun, *joined: Any) -> Noun:
        """Return a noun phrase with what commas and *and* join to it."""
        nps, joined = (whole := _with_own_parts((nps, *joined)))[0], whole[1:]
        phrase, extra = nps.phrase, nps.extra
        for joint, mods in zip(joined[::2], joined[1::2], strict=True):
            if joint.type in ("OJ", "LJ"):
                one = mods.phrase.pronoun == "one" and mods.phrase.determiner == "the" and not mods.phrase.negated
                one = one and mods.phrase.plural == phrase.plural
                if (
                    joint.value == "," and one and not phrase.members
                ):  # apposition: 'the picture on the left, the one in red'
                    kind = Predicate("kind", (mods.phrase,), mods.phrase.span)
                    phrase = replace(
                        phrase, predicates=(*phrase.predicates, kind), span=union(phrase.span, mods.phrase.span)
                    )
                    continue
                members = (*(phrase.members or (phrase,)), *(mods.phrase.members or (mods.phrase,)))
                phrase = NounPhrase(union(phrase.span, mods.phrase.span), plural=True, members=members, joined_by="and")
                extra += mods.extra
                continue
            if joint.value in ("and", "or") and phrase.predicates and not phrase.members:
                shared = _shared([("", phrase.predicates[-1:]), (joint.value, tuple(mods))])
                phrase = replace(phrase, predicates=(*phrase.predicates[:-1], *shared[0][1]))
                mods = shared[1][1]
                if joint.value == "or" and mods and shared[0][1][0].relation != "like":
                    either = [replace(p, adverbs=(*p.adverbs, "possibly")) for p in (shared[0][1][0], mods[0])]
                    phrase = replace(phrase, predicates=(*phrase.predicates[:-1], either[0]))
                    mods = (either[1], *mods[1:])  # 'a napkin in the middle or on the side plate'
            if phrase.members and all(member.predicates for member in phrase.members):
                *rest, last = phrase.members  # 'A on the left and B on the right, next to C'
                last = _restricted(last, mods)
                phrase = replace(phrase, members=(*rest, last), span=union(phrase.span, last.span))
            elif (
                (is_place(phrase) and not _is_group(phrase))
                or phrase.pronoun in ("it", "they", "this")
                or phrase.members
            ):
                extra += tuple(mods)
            else:
                phrase = _restricted(phrase, mods)
        return Noun(phrase, extra)

    def nps(self, *parts: Any) -> Noun:
        """Return a noun phrase, or the coordination of several."""
        if len(parts) == 1:
            only: Noun = parts[0]
            return only
        parts = _with_own_parts(parts)
        if len(parts) == 1:
            single: Noun = parts[0]
            return single
        if len(parts) > 2 and _is_second_content(parts[-3].phrase, parts[-1].phrase):
            return self.nps(*parts[:-2])
        members = [part.phrase for part in parts[::2]]
        joints = [part.value for part in parts[1::2]]
        first = members[0]
        if (
            is_place(first)
            and not (_is_group(first) and any(member.determiner is not None for member in members[1:]))
            and first.of is not None
            and not any(is_place(m) and m.head in DIRECTION_WORDS for m in members[1:])
        ):
            rest = (Noun(first.of), *parts[1:])  # 'to the right of the sink and the cabinet'
            inner = self.nps(*rest)
            return Noun(
                replace(first, of=inner.phrase, span=union(first.span, inner.phrase.span)),
                (*parts[0].extra, *inner.extra),
            )
        if len(members) == 2 and joints == [","] and _completes(first, members[1]):  # 'the small, rainbow towel'
            second = members[1]
            whole = replace(
                second,
                determiner=first.determiner,
                adjectives=(*first.adjectives, *second.adjectives),
                span=union(first.span, second.span),
            )
            return Noun(whole, parts[2].extra)
        extra = tuple(p for part in parts[::2] for p in part.extra)
        span = union(members[0].span, members[-1].span)
        if (
            "or" not in joints
            and "and" not in joints
            and "but" not in joints
            and len(members) == 2
            and not members[1].negated
        ):
            first, second = members
            own = second.owner is not None and second.owner.pronoun in ("it", "they")
            named = second.determiner is not None or (second.owner is not None and not own)
            other = first.plural != second.plural and second.determiner == "the" and bool(second.predicates)
            if named and not other and not is_place(first) and first.pronoun is None:  # apposition
                kind = Predicate("kind", (second,), second.span)
                return Noun(replace(first, predicates=(*first.predicates, kind), span=span), extra)
        joined_by = "or" if "or" in joints else "and"
        if first.determiner == "neither":
            members = [replace(member, determiner="the") for member in members]
            whole = NounPhrase(span, determiner="neither", plural=True, members=tuple(members), joined_by="and")
            return Noun(whole, extra)
        return Noun(NounPhrase(span, plural=True, members=tuple(members), joined_by=joined_by), extra)

    raws = nps

    def np(self, noun: NounPhrase, mods: tuple[Predicate, ...] | None) -> Noun:
        """Return a noun phrase with its restrictions."""
        if not mods:
            return Noun(noun)
        if noun.pronoun in ("it", "they", "me", "you", "we", "this", "he", "she"):
            return Noun(noun, tuple(mods))
        if shared := tuple(p for p in mods if ALONG_WITH in p.adverbs):  # 'on the tray together with the jug'
            mods = tuple(p for p in mods if p not in shared)
            return Noun(_restricted(noun, mods) if mods else noun, shared)
        if last_word(noun.head) in PARTS | FRONTS:
            mods = tuple(map(aimed, mods))  # 'its handle toward the left'
        if noun.head == "back" and noun.owner is not None and mods[0].relation == "to":
            return Noun(_restricted(noun, (replace(mods[0], relation="facing"), *mods[1:])))
        if noun.head in _PARTS and mods[0].relation in ("facing", "pointing"):
            return Noun(_restricted(noun, mods))
        if is_place(noun) and not noun.predicates:
            return _place_with(noun, tuple(mods))
        flat_below = last_word(noun.head) in SURFACES  # 'the cake on the windowsill with a cloth over it'
        over = {p.relation for p in mods if p.of_one} <= {"above", "around"}
        outer = tuple(p for p in mods if p.of_one) if noun.plural or (flat_below and over) else ()
        held = any(p.of_one and p.relation == "inside" for p in mods)
        if held and last_word(noun.head) not in VESSELS | HOLDERS:
            outer = tuple(p for p in mods if p.of_one)  # 'the bucket stands by the hatch with the tongs in it'
        if noun.determiner is not None:  # 'on a table under the skylight with the pedal on the floor beneath it'
            outer += tuple(p for p in mods if _is_absolute(p))
        if outer:  # 'the plate above the forks with a knife across it'
            mods = tuple(p for p in mods if p not in outer)
            return Noun(_restricted(noun, mods) if mods else noun, outer)
        return Noun(_restricted(noun, mods))

    def noun(self, chunk: Chunk) -> NounPhrase:
        """Return the noun phrase of a chunk."""
        phrase: NounPhrase = chunk.value
        return phrase

    def raw(self, chunk: Chunk) -> Noun:
        """Return a noun phrase that takes no restrictions."""
        return Noun(chunk.value)

    def complement(self, chunk: Chunk, of: Chunk, thing: Noun) -> NounPhrase:
        """Return *the end of the shelf* and *a pair of boots*."""
        phrase: NounPhrase = chunk.value
        said = thing.phrase.predicates
        thing, its = _of_the_subject(thing)
        inner = thing.phrase
        on_it = tuple(p for p in inner.predicates if any(a.pronoun in ("it", "they") for a in p.arguments))
        if on_it:  # 'the desk with a piece of paper on it'
            inner = replace(inner, predicates=tuple(p for p in inner.predicates if p not in on_it))
            its = (*on_it, *its)
        share = phrase.head in _FRACTIONS and (inner.pronoun is not None or inner.plural) and phrase.owner is None
        if share and not phrase.adjectives:
            return replace(inner, plural=True, span=union(phrase.span, inner.span))  # 'two thirds of them'
        aims = tuple(p for p in inner.predicates if p.relation in ("pointing", "facing") or _is_side(p))
        if aims and last_word(phrase.head) in PARTS:  # 'the handle of the spoon pointing to the right'
            inner = replace(inner, predicates=tuple(p for p in inner.predicates if p not in aims))
            its = (*aims, *its)
        kind = last_word(phrase.head) in _KINDS and inner.head and inner.determiner is None and inner.count is None
        if kind and not inner.members and phrase.owner is None:  # 'any type of napkin'
            plural = inner.plural or phrase.determiner in ("any", "all", "several")
            return replace(inner, plural=plural, span=union(phrase.span, inner.span), predicates=inner.predicates)
        if phrase.head in _RESTS and phrase.owner is None and inner.head and not inner.members:
            others = Adjective("remaining", "other", Degree.PLAIN, phrase.span)
            return replace(inner, adjectives=(others, *inner.adjectives), span=union(phrase.span, inner.span))
        if not phrase.head and phrase.pronoun is None and phrase.determiner in _QUANTIFIERS and inner.head:
            return replace(inner, plural=True, span=union(phrase.span, inner.span))  # 'most of the knives'
        if phrase.head.rpartition(" ")[2] in _AMOUNTS and inner.head and not inner.owner and inner.determiner is None:
            span = union(phrase.span, inner.span)  # 'a thin layer of gravel', '8 cm of soil'
            return replace(inner, determiner=phrase.determiner if phrase.determiner != "each" else "the", span=span)
        if not phrase.head and phrase.count is not None and phrase.determiner == "a":  # 'a pair of boots'
            return replace(inner, count=phrase.count, plural=True, span=union(phrase.span, inner.span))
        bare = _is_bare(inner) and all(p.positive for p in inner.predicates)
        if bare and inner.predicates and phrase.head and not is_place(phrase) and last_word(phrase.head) not in PARTS:
            inner, its = replace(inner, predicates=()), said  # 'a glass of water on the table'
        return replace(
            phrase, of=inner, span=union(phrase.span, inner.span), predicates=(*phrase.predicates, *thing.extra, *its)
        )

    def raw_complement(self, chunk: Chunk, of: Chunk, thing: Noun) -> Noun:
        """Return *the end of the shelf* without restrictions."""
        return Noun(self.complement(chunk, of, thing))

    def mods(self, *parts: tuple[Predicate, ...]) -> tuple[Predicate, ...]:
        """Return the restrictions of a noun phrase; the first of several alternatives restricts nothing either."""
        found = merged(parts, check=False)
        open_at = {i for i, p in enumerate(found) for i in (i - 1, i) if _OR in p.adverbs}
        return tuple(p for i, p in enumerate(found) if i not in open_at)

    # predicates

    def preds(self, *parts: Any) -> tuple[Predication, ...]:
        """Return predicates, grouped by their joints."""
        groups: list[tuple[str, list[Any]]] = [("", [])]
        for part in parts:
            if isinstance(part, Chunk):
                groups.append((part.value, []))
            else:
                groups[-1][1].append(part)
        for (_, before), (_, group) in pairwise(groups):
            if not (before and before[0] and group and group[0]):
                continue
            aim, denied = before[0][0].relation, group[0][0]
            if aim in ("pointing", "facing") and denied.relation == "at" and not denied.positive:
                group[0] = (replace(denied, relation=aim), *group[0][1:])  # 'pointing at it, not at me'
        made = [(link, merged(tuple(group), check=False)) for link, group in groups]
        found: list[Predication] = []
        for link, predicates in _shared(made):
            others = [p for p in predicates if _OR in p.adverbs]
            kept = tuple(p for p in predicates if _OR not in p.adverbs)
            found.append(Predication(kept, link == "or", link == "but"))
            found += [Predication((replace(p, adverbs=tuple(a for a in p.adverbs if a != _OR)),), True) for p in others]
        return tuple(found)

    def pp(self, prep: Chunk, noun: Noun, than: Chunk | None, other: Noun | None) -> tuple[Predicate, ...]:
        """Return the predicates of a preposition and its object."""
        relator: Relator = prep.value
        relation = relator.preposition.relation
        span = union(prep.span, noun.phrase.span)
        extra = noun.extra
        noun, its = _of_the_subject(noun)
        extra = (*extra, *its)
        aims = [p for p in noun.phrase.predicates if TOWARDS in p.adverbs and not p.arguments]
        if aims:  # 'behind the jug towards the right'
            misunderstood(aims[0].span, "this does not say of what this is a direction")
            others = tuple(p for p in noun.phrase.predicates if p not in aims)
            noun = Noun(replace(noun.phrase, predicates=others), noun.extra)
        last_said = noun.phrase.predicates[-1:]
        if last_said and last_said[0].relation == "upside_down" and "that" not in last_said[0].adverbs:
            bare = replace(noun.phrase, predicates=noun.phrase.predicates[:-1])
            noun, extra = Noun(bare, noun.extra), (*last_said, *extra)  # 'lay the cards beside the board face down'
        of = noun.phrase.of if noun.phrase.head in _SIDES else None
        known = of or noun.phrase
        is_known = (relation in _DIRECTIONS or of is not None) and known.determiner == "the"
        if is_known and known.predicates and _is_on_new(known.predicates[-1]):  # 'it lies left of the radio on a mat'
            extra = (known.predicates[-1], *extra)
            known = replace(known, predicates=known.predicates[:-1])
            noun = Noun(known if of is None else replace(noun.phrase, of=known), noun.extra)
        if other is not None:
            span, extra = union(span, other.phrase.span), (*extra, *other.extra)
        last_end = noun.phrase.members[-1] if relation == "between" and noun.phrase.members else None
        of_one = tuple(p for p in last_end.predicates if p.of_one) if last_end is not None else ()
        if last_end is not None and of_one:  # 'it stands between the door and the mirror with a coat on it'
            bare = replace(last_end, predicates=tuple(p for p in last_end.predicates if p not in of_one))
            noun = Noun(replace(noun.phrase, members=(*noun.phrase.members[:-1], bare)), noun.extra)
            extra = (*extra, *of_one)
        if noun.phrase.head.endswith(("degree angle", "degree")) and relation in ("at", "inside"):
            target = next((p for p in (*noun.phrase.predicates, *extra) if p.relation == "to"), None)
            return () if target is None else (replace(target, relation="diagonal", span=span),)
        if relation == "opposite" and noun.phrase.head in _SIDES and noun.phrase.of is None:
            misunderstood(span, "this does not say what is on the other side")
            return (*noun.phrase.predicates, *extra)  # 'opposite left'
        if relation == "opposite" and relator.preposition.phrase.endswith("side of") and noun.phrase.head:
            more = tuple(p for p in noun.phrase.predicates if p.relation != "from")
            return (other_side(relator, noun.phrase, span), *more, *extra)
        if noun.phrase.members and all(is_place(member) for member in noun.phrase.members):
            spots = _places(relator, noun.phrase.members, span)
            if noun.phrase.joined_by == "or":  # 'in either the middle or the back of the crate'
                spots[1:] = [replace(p, adverbs=(*p.adverbs, _OR)) for p in spots[1:]]
            return (*spots, *extra)
        if relator.preposition.phrase in _TOWARDS and is_place(noun.phrase) and noun.phrase.head not in _NO_TARGETS:
            here = replace(relator, preposition=prepositions()["at"], adverbs=(*relator.adverbs, TOWARDS))
            found = place(here, noun.phrase, span)  # 'keep it toward the back of the shelf'
            return (*(() if found is None else (found,)), *noun.phrase.predicates, *extra)
        side = PLACE_NOUNS.get(noun.phrase.head, "")
        if relation in ("pointing", "facing") and side in _SIDES and noun.phrase.of is None and not noun.phrase.members:
            aim = Adjective(side, "position", Degree.PLAIN, noun.phrase.span)  # 'pointing to the right'
            return (Predicate(relation, (), span, value=aim, positive=relator.positive), *extra)
        own = noun.phrase.owner is not None and noun.phrase.owner.pronoun in ("it", "he", "she", "they")
        if own and noun.phrase.head == "head" and relation == "on":  # 'the torch stands on its head'
            turned = Predicate("upside_down", (), span, positive=relator.positive)
            return (turned, *noun.phrase.predicates, *extra)
        person = noun.phrase.owner
        viewed = person is not None and person.pronoun in ("me", "you", "we") and noun.phrase.head in ("back", "rear")
        if person is not None and viewed and relation in ("at", "on", "inside", "to"):  # 'the window at my back'
            return (Predicate("behind", (person,), span, positive=relator.positive), *extra)
        whole = noun.phrase.of if noun.phrase.of is not None else noun.phrase
        is_pointed_at = noun.phrase.head in _POINTED_AT and noun.phrase.determiner in ("this", "that")
        measured = last_word(noun.phrase.head).rpartition("-")[2] in _MEASURES  # 'at eye-level'
        ranked = any(a.dimension in ("position", "rank") for a in noun.phrase.adjectives)
        if noun.phrase.head == "level" and ranked and relation in ("on", "at", "inside"):
            measured, relation = False, "on"  # 'on the bottom level'
        if (measured or is_pointed_at) and relation in ("at", "on"):
            misunderstood(span, f"'{noun.phrase.head}' is not a place")
            places = tuple(
                replace(p, relation="far") if p.relation == "from" else p
                for p in noun.phrase.predicates if p.arguments and (measured or p.relation == "from")
            )  # fmt: skip
            return (*places, *extra)  # 'at a safe distance from the stove', 'at eye level behind the desk'
        if last_word(whole.head) in NEVER_PLACES:  # 'under the contract', 'at the bottom of its popularity'
            misunderstood(span, f"'{whole.head}' is not a place")
            return extra
        lining = noun.phrase.head == "inside" and relation in ("around", "along", "against")
        if lining and noun.phrase.of is not None:  # 'tuck towels around the inside of the crate'
            return (Predicate("inside", (noun.phrase.of,), span, positive=relator.positive), *extra)
        vague = noun.phrase.head in ("area", "section", "portion") and noun.phrase.determiner in ("a", "an", "any")
        if vague and not directions_of(noun.phrase) and noun.phrase.of is None and relation in ("inside", "at", "on"):
            misunderstood(span, "this does not say which place is meant")
            near = tuple(p for p in (*noun.phrase.predicates, *extra) if p.positive and p.arguments)
            return (Predicate("there", (), span, positive=relator.positive), *near)
        ground = noun.phrase.of if is_place(noun.phrase) else None
        if (
            ground is not None
            and ground.determiner == "the"
            and ground.predicates
            and _is_on_new(ground.predicates[-1])
        ):
            bare = replace(ground, predicates=ground.predicates[:-1])  # 'in the middle of the table on a tray'
            noun, extra = Noun(replace(noun.phrase, of=bare), noun.extra), (ground.predicates[-1], *extra)
        found = _positioned(relator, noun.phrase, span)
        if found is not None:
            main, rest = _with_argument(found, (*noun.phrase.predicates, *extra))
            return (main, *rest)
        if noun.phrase.head in _LEVELS and (
            noun.phrase.determiner == "same" or any(a.word == "same" for a in noun.phrase.adjectives)
        ):
            directed = tuple(p for p in noun.phrase.predicates if p.relation != "as")
            level = Predicate(
                "level_with", tuple(a for p in noun.phrase.predicates if p.relation == "as" for a in p.arguments), span
            )
            return (*((level,) if level.arguments else ()), *directed, *extra)
        last = noun.phrase.predicates[-1] if noun.phrase.predicates else None
        if (
            last is not None
            and (relation in _LEVEL_RELATIONS or (relation == "next_to" and last.part == "side"))
            and last.relation in ("left", "right")
            and not last.arguments
            and (last.part is None or (last.part == "side" and noun.phrase.determiner != "a"))
        ):  # 'above X to the left', 'above the plate on the left side'
            bare = replace(noun.phrase, predicates=noun.phrase.predicates[:-1])
            noun, extra = Noun(bare, extra), (replace(last, arguments=(bare,), part=None), *extra)
        if last_word(noun.phrase.head) in GAPS and relation in ("inside", "on") and noun.phrase.predicates:
            between = tuple(p for p in noun.phrase.predicates if p.relation == "between")
            if between:  # 'in the space between the plate and the cup'
                return (*between, *extra)
        hour = next(
            (
                p
                for p in noun.phrase.predicates
                if p.value is not None and p.value.dimension == "clock" and not p.arguments
            ),
            None,
        )
        if hour is not None:
            rest = tuple(p for p in noun.phrase.predicates if p is not hour)
            noun = Noun(replace(noun.phrase, predicates=rest), extra)
            extra = (*extra, replace(hour, arguments=(noun.phrase,)))
        things = noun.phrase.count is not None or (noun.phrase.plural and noun.phrase.head not in SUBSTANCES)
        named = noun.phrase.members or noun.phrase.determiner in ("a", "an", "the", "no") or things
        if relation == "material" and named:  # 'made up of four sections'
            misunderstood(span, "this says which things belong together, not where they are")
            return extra  # 'a set consisting of a fork and a knife'
        if relation == "material":
            word = Adjective(noun.phrase.head or "unknown", "material", Degree.PLAIN, noun.phrase.span)
            return (Predicate("material", (noun.phrase,), span, value=word, positive=relator.positive), *extra)
        last_part = last_word(noun.phrase.head).rpartition("-")[2]  # 'in an L-shape'
        shown = last_part in _PICTURES and noun.phrase.determiner in ("this", "that", "the")
        shown = shown or noun.phrase.head in ("half circle", "half moon")
        if noun.phrase.members and all(last_word(m.head) in CIRCUMSTANCES for m in noun.phrase.members):
            misunderstood(span, "these words name no place")  # 'in different shapes and sizes'
            return extra
        if (last_part in ARRANGEMENTS | CIRCUMSTANCES or shown) and relation == "inside":
            misunderstood(span, f"'{noun.phrase.head}' is not a place")
            of_subject = noun.phrase.predicates if noun.phrase.determiner in ("a", "an", None) else ()
            return (Predicate("there", (), span, positive=relator.positive), *of_subject, *extra)
        if relation == "by" and noun.phrase.owner is None and last_word(noun.phrase.head) in DEGREES:
            misunderstood(span, f"'{noun.phrase.head}' says how much, not where")
            return (*noun.phrase.predicates, *extra)  # 'turned by ninety degrees'
        if relation in ("inside", "at") and last_word(noun.phrase.head) in _OCCASIONS:
            misunderstood(span, f"'{noun.phrase.head}' is not a place")
            return (*noun.phrase.predicates, *extra)  # 'in a festive meal', 'at one time'
        manner = relation == "by" and noun.phrase.head in _MANNERS
        ruled = relation == "by" and noun.phrase.head in _RULES and noun.phrase.determiner == "the"
        unmarked = noun.phrase.determiner is None and noun.phrase.owner is None and noun.phrase.count is None
        if relation in ("by", "at") and unmarked and not noun.phrase.known and not noun.phrase.adjectives:
            misunderstood(span, f"'{noun.phrase.head}' is not a place")  # 'by contrast', 'at dusk'
            return (*noun.phrase.predicates, *extra)
        plain = noun.phrase.determiner in (None, "a", "an") and not noun.phrase.adjectives
        idle = last_word(noun.phrase.head) in NOT_PLACES and (plain or noun.phrase.determiner is None)
        known_place = noun.phrase.head in ("place", "spot", "position") and noun.phrase.of is None
        known_place = known_place and (
            noun.phrase.determiner == "same" or any(a.word in _KNOWN for a in noun.phrase.adjectives)
        )  # 'always in the same place'
        single = noun.phrase.determiner is None and not noun.phrase.plural and bool(noun.phrase.head)
        idle = idle or (known_place and not noun.phrase.predicates)
        idle = idle or (relator.preposition.phrase == "before" and single and noun.phrase.count is None)
        idle = idle and noun.phrase.owner is None  # 'on display', but 'above your display'
        if idle or (plain and manner) or ruled:
            misunderstood(prep.span if noun.phrase.predicates else span, f"'{noun.phrase.head}' is not a place")
            return (*noun.phrase.predicates, *extra)
        if relation == "-":
            misunderstood(span, f"'{relator.preposition.phrase}' does not say where something is")
            personal = whole.pronoun in PERSONS and not whole.head  # 'a mug for each of you beside the kettle'
            return (*(p for p in noun.phrase.predicates if p.arguments and personal), *extra)
        degree = relator.preposition.degree
        if "as" in relator.adverbs and relation in ("near", "far"):
            degree = Degree.SUPERLATIVE
        value = None
        if relator.rank is not None:
            value = Adjective("ordinal", "rank", degree, prep.span, rank=relator.rank)
        noun, again = _of_the_thing_placed(noun)
        extra = (*again, *extra)
        arguments = noun.phrase
        written = relator.preposition.phrase
        shaped = written == "into" and noun.phrase.determiner in ("a", "an", None)
        moving = written == "over" or written in AWAY_FROM or written.startswith(("from ", "to the "))
        kept = shaped or moving or (written in _TOWARDS and is_place(noun.phrase)) or "side of" in written
        adverbs = (*relator.adverbs, written) if kept else relator.adverbs
        made = Predicate(
            relation, arguments_of(relation, arguments), span, value=value, degree=degree,
            than=None if other is None else other.phrase, adverbs=adverbs, positive=relator.positive,
        )  # fmt: skip
        return (made, *extra)

    def alone(self, chunk: Chunk) -> tuple[Predicate, ...]:
        """Return the predicate of a place word: *above*, *upside down*."""
        relator: Relator = chunk.value
        preposition = relator.preposition
        part = None
        if preposition.phrase.startswith("far ") and preposition.relation in ("left", "right"):
            return (
                Predicate(
                    "part", (), chunk.span, part=preposition.phrase, adverbs=relator.adverbs, positive=relator.positive
                ),
            )
        if preposition.relation == "row":
            return (Predicate("row", (), chunk.span, part=preposition.phrase),)
        if preposition.relation in ("up", "down", "forward", "backward", "inward", "outward"):
            aim = Adjective(preposition.relation, "position", Degree.PLAIN, chunk.span)
            return (Predicate("pointing", (), chunk.span, value=aim, positive=relator.positive),)
        value = None
        if relator.rank is not None:
            value = Adjective("ordinal", "rank", preposition.degree, chunk.span, rank=relator.rank)
        return (
            Predicate(
                preposition.relation, (), chunk.span, value=value, part=part, degree=preposition.degree,
                adverbs=relator.adverbs, positive=relator.positive,
            ),
        )  # fmt: skip

    def participle(self, chunk: Chunk) -> tuple[Predicate, ...]:
        """Return a mark for a participle, which :func:`merged` joins to what follows."""
        group: VerbGroup = chunk.value
        return (
            Predicate(f"~{group.lemma}~{group.kind}", (), chunk.span, adverbs=group.adverbs, positive=group.positive),
        )

    def holding(self, chunk: Chunk, nps: Noun) -> tuple[Predicate, ...]:
        """Return the predicates of *facing the window*, *holding a pen*."""
        phrase = nps.phrase
        held = chunk.value.lemma in ("contain", "hold") and _is_bare(phrase) and not phrase.members
        if held and all(p.positive and p.relation in ("on", "inside") for p in phrase.predicates):
            inner = Noun(replace(phrase, predicates=()), nps.extra)  # 'a box containing pens on the shelf'
            return (*transitive(chunk.value, inner, chunk.span), *phrase.predicates)
        return transitive(chunk.value, nps, chunk.span)

    def withs(self, chunk: Chunk, *nouns: Any) -> tuple[Predicate, ...]:
        """Return the predicates of *with a napkin on it*."""
        relator: Relator = chunk.value
        found: list[Predicate] = []
        several: NounPhrase | None = None
        for noun in nouns[::2]:
            turned = noun.extra[:1] and noun.extra[0].relation in ("facing", "pointing")
            if turned and is_place(noun.phrase):  # 'with the inside facing up'
                noun = Noun(replace(noun.phrase, predicates=noun.extra))
            for i, member in enumerate(_with_shared_place(noun.phrase)):
                if several is not None:
                    member = _beside(member, several)
                several = replace(member, predicates=()) if member.plural else several
                made = _accompanied(relator, member, union(chunk.span, noun.phrase.span))
                joined = relator.preposition.phrase in _SHARING_PLACES and not member.predicates and relator.positive
                if i and noun.phrase.joined_by == "or":  # 'cover the bowl with a cloth or a lid'
                    made = [replace(p, adverbs=(*p.adverbs, _OR)) for p in made]
                found += [replace(p, adverbs=(*p.adverbs, ALONG_WITH)) for p in made] if joined else made
            found += noun.extra
        return tuple(found)

    def compared(self, adjective: Chunk, than: Chunk, noun: Noun) -> tuple[Predicate, ...]:
        """Return the predicates of *taller than the jug*."""
        words: tuple[Adjective, ...] = adjective.value
        *others, compared = words
        span = union(adjective.span, noun.phrase.span)
        if compared.word in ("near", "far"):
            made = Predicate(compared.word, (), span, value=compared, degree=Degree.COMPARATIVE, than=noun.phrase)
        else:
            relation = COMPARISONS.get(compared.word, "more")
            if compared.word in ("left", "right"):
                relation = compared.word
            made = Predicate(relation, (noun.phrase,), span, value=compared, degree=Degree.COMPARATIVE)
        return (*_properties(tuple(others)), made, *noun.extra)

    def adjectives(self, chunk: Chunk) -> tuple[Predicate, ...]:
        """Return a predicate for each adjective."""
        return _properties(chunk.value)

    def measured(self, chunk: Chunk) -> tuple[Predicate, ...]:
        """Return a distance without its object."""
        metres, hedge, bound = chunk.value
        measure = Measure(metres, hedge, bound, chunk.span)
        relation = {"<": "distance_less", ">": "distance_more"}.get(bound, "distance")
        return (Predicate(relation, (), chunk.span, measure=measure),)

    def relative(self, rel: Chunk, verb: Verb) -> tuple[Predicate, ...]:
        """Return the predicates of *that stands on the tray*."""
        flattened = tuple(flat(verb))
        if verb.group.modal in _OBLIGING:  # 'the lid, which needs to be removed'
            flattened = tuple(p for p in flattened if p.relation != "state")
        return tuple(replace(p, adverbs=(*p.adverbs, "that")) if p.relation in _OF_ITS_OWN else p for p in flattened)

    def reduced(self, rel: Chunk, predications: tuple[Predication, ...]) -> tuple[Predicate, ...]:
        """Return the predicates of *that next to the tray*."""
        return tuple(p for part in predications for p in part.predicates)

    def object_relative(self, rel: Chunk, noun: Noun, verb: Verb) -> tuple[Predicate, ...]:
        """Return the predicates of *that the cup stands on* and *which I keep under the mug*."""
        person = noun.phrase.pronoun in ("me", "you", "we", "someone", "he", "she")
        predicates = flat(replace(verb, thing=None) if person else verb)
        if person or not predicates:
            return tuple(p for p in predicates if p.arguments or p.relation in DIRECTION_RELATIONS)
        last = predicates[-1]
        if not last.arguments:
            span = union(noun.phrase.span, last.span)
            return (*predicates[:-1], replace(last, arguments=(noun.phrase,), reversed=True, span=span))
        misunderstood(union(rel.span, verb.span), "this relative clause does not say how the two things lie")
        return ()

    def whose(self, whose: Chunk, noun: Noun, verb: Verb) -> tuple[Predicate, ...]:
        """Return the predicates of *whose handle points to the right*."""
        return tuple(replace(p, subject_part=noun.phrase) for p in flat(verb))


def _with_contents(thing: NounPhrase, predications: tuple[Predication, ...] | None) -> tuple[Predication, ...] | None:
    """Return the place after *place the bowl with rice to the right* as that of the bowl, and not of the rice."""
    first = predications[0].predicates[:1] if predications else ()
    held = first[0].arguments[0] if first and first[0].relation == "with" and len(first[0].arguments) == 1 else None
    alone = predications is not None and len(predications) == 1 and len(predications[0].predicates) == 1
    bare = held is not None and held.determiner is None and held.count is None and held.owner is None
    if predications is None or held is None or not (alone and bare) or not held.predicates or not held.head:
        return predications
    if last_word(thing.head) in SURFACES - {"tray"} or thing.members:
        return predications  # 'lay the table with forks on the left'
    holds = replace(first[0], arguments=(replace(held, predicates=()),))
    return (Predication((holds, *held.predicates)),)


def _against_supports(lemma: str, predications: tuple[Predication, ...]) -> tuple[Predication, ...]:
    """Return *lean the picture in its frame against the wall* with the picture against the wall, and not its frame."""
    last = predications[-1].predicates[-1:] if predications and lemma in ("lean", "prop", "rest") else ()
    holder = last[0].arguments[-1] if last and last[0].arguments else None
    against = tuple(p for p in holder.predicates if p.relation == "against") if holder is not None else ()
    if holder is None or not against:
        return predications
    kept = replace(holder, predicates=tuple(p for p in holder.predicates if p not in against))
    inner = replace(last[0], arguments=(*last[0].arguments[:-1], kept))
    part = replace(predications[-1], predicates=(*predications[-1].predicates[:-1], inner, *against))
    return (*predications[:-1], part)


def _is_bare(phrase: NounPhrase) -> bool:
    """Return True for a noun without an article, an owner and a number, such as what a vessel contains."""
    return phrase.determiner is None and phrase.owner is None and phrase.count is None and phrase.pronoun is None


def _is_absolute(predicate: Predicate) -> bool:
    """Return True for *with the pedal on the floor*: a definite thing that is somewhere itself."""
    thing = predicate.arguments[0] if predicate.relation == "with" and predicate.arguments else None
    placed = thing is not None and any(p.arguments for p in thing.predicates)
    return thing is not None and placed and thing.determiner == "the" and bool(thing.head)


def _is_second_content(vessels: NounPhrase, other: NounPhrase) -> bool:
    """Return True for *the cruets of wine* and *water*, which the cruets hold too."""
    content = vessels.of
    bare = other.determiner is None and other.owner is None and other.count is None and not other.predicates
    return (
        content is not None and vessels.plural and not content.predicates and bare
        and content.head in SUBSTANCES and other.head in SUBSTANCES
    )  # fmt: skip


def flat(verb: Verb) -> list[Predicate]:
    """Return what a verb says about its subject as one list; alternatives after *or* are left out.

    Parameters
    ----------
    verb
        Verb with what it says.

    Returns
    -------
    list of Predicate
        Predicates of the subject. Negation and adverbs of the verb are carried over to each; predicates after *but*
        keep their own.
    """
    found: list[Predicate] = []
    contrasted: list[Predicate] = []
    after_but = False
    for part in verb.predications:
        after_but = after_but or part.contrast  # also 'behind the jar' in 'not on it but under it, behind the jar'
        if after_but and not part.choice:
            contrasted += part.predicates
        elif not part.choice:
            found += part.predicates
    if verb.thing is not None:
        found[:0] = transitive(replace(verb.group, positive=True, adverbs=()), verb.thing, verb.span)
    if verb.nominal is not None:
        phrase = verb.nominal.phrase
        found.insert(0, Predicate("kind", (phrase,), phrase.span))
    if not verb.group.positive:
        found = [replace(p, positive=not p.positive) for p in found]
    found += contrasted
    if verb.group.adverbs:
        found = [replace(p, adverbs=(*verb.group.adverbs, *p.adverbs)) for p in found]
    return found


def _beside(member: NounPhrase, several: NounPhrase) -> NounPhrase:
    """Return *the knife to their right* after *with two limes on it* with the limes as what it is beside."""
    made = []
    for p in member.predicates:
        is_of_several = bool(p.arguments) and all(a.pronoun == "they" for a in p.arguments)
        own = p.viewpoint is not None and p.viewpoint.own is not None and p.viewpoint.own.pronoun == "they"
        made.append(replace(p, arguments=(several,), viewpoint=None if own else p.viewpoint) if is_of_several else p)
    return replace(member, predicates=tuple(made))


def _with_own_parts(parts: tuple[Any, ...]) -> tuple[Any, ...]:
    """Join *its nozzle turned towards the viewer* to the thing before it, of which it is a part."""
    kept: list[Any] = [parts[0]]
    owner_at = 0  # in `kept`: modifiers may stand between the thing and its part
    for joint, part in zip(parts[1::2], parts[2::2], strict=True):
        phrase = part.phrase if isinstance(part, Noun) else None
        before = kept[owner_at]
        predicates = phrase.predicates if phrase is not None else ()
        aims = bool(predicates) and all(p.relation in ("facing", "pointing", "state") for p in predicates)
        owner = None if phrase is None or phrase.owner is None else phrase.owner.pronoun
        if phrase is not None and aims and owner == "it" and before.phrase.head:
            bare = replace(phrase, predicates=())
            predicates = tuple(replace(p, subject_part=bare) for p in predicates)
            kept[owner_at] = Noun(_restricted(before.phrase, predicates), (*before.extra, *part.extra))
        else:
            kept += [joint, part]
            owner_at = len(kept) - 1 if phrase is not None else owner_at
    return tuple(kept)


def _with_shared_place(phrase: NounPhrase) -> tuple[NounPhrase, ...]:
    """Return the members of *three pens and a ruler in it*, all of them in it."""
    members = phrase.members or (phrase,)
    last = members[-1].predicates
    if len(members) < 2 or not last or not any(a.pronoun in ("it", "they") for p in last for a in p.arguments):
        return members
    return tuple(member if member.predicates else replace(member, predicates=last) for member in members)


def _restricted(phrase: NounPhrase, mods: tuple[Predicate, ...]) -> NounPhrase:
    related = _related(phrase, mods)
    if related != mods:
        phrase = replace(phrase, adjectives=tuple(a for a in phrase.adjectives if a.word not in ("near", "far")))
    mods, adjectives = _ordinals(phrase, related)
    mods = tuple(checked(list(mods), phrase))
    last = mods[-1].span if mods else phrase.span
    return replace(phrase, predicates=(*phrase.predicates, *mods), adjectives=adjectives, span=union(phrase.span, last))


def _related(phrase: NounPhrase, mods: tuple[Predicate, ...]) -> tuple[Predicate, ...]:
    """Join *to* and *from* with the adjective before the noun: *the closest block to me*."""
    near = next((a for a in phrase.adjectives if a.word in ("near", "far") and a.degree is not Degree.PLAIN), None)
    if near is None:
        return mods
    return tuple(
        replace(p, relation=near.word, degree=near.degree, value=near)
        if p.relation in ("to", "from") and p.arguments
        else p
        for p in mods
    )


def _ordinals(phrase: NounPhrase, mods: tuple[Predicate, ...]) -> tuple[tuple[Predicate, ...], tuple[Adjective, ...]]:
    """Return the modifiers with *from the left* joined to the ordinal before it: *the second cup from the left*."""
    ranked = next((a for a in phrase.adjectives if a.rank is not None), None)
    found, adjectives = [], phrase.adjectives
    for mod in mods:
        if mod.relation == "ordinal" and mod.value is None:
            if ranked is None:
                misunderstood(
                    mod.span, "this counts from a side, but no number stands before it", "the second cup from the left"
                )
                continue
            mod = replace(mod, value=ranked, span=union(ranked.span, mod.span))
            adjectives = tuple(a for a in adjectives if a is not ranked)
        found.append(mod)
    return tuple(found), adjectives


def _completes(first: NounPhrase, second: NounPhrase) -> bool:
    """Return True if the second phrase has the noun of the adjectives in the first one."""
    bare = not first.head and first.pronoun is None and first.determiner is not None and not first.predicates
    return bare and bool(first.adjectives) and bool(second.head) and second.determiner is None and second.count is None


def _place_with(noun: NounPhrase, mods: tuple[Predicate, ...]) -> Noun:
    """Return a place with its complement after *to*: *at the lower side to X*; further phrases belong above it."""
    first = mods[0]
    if first.relation in ("to", "-to") and noun.of is None and len(first.arguments) == 1:
        return Noun(replace(noun, of=first.arguments[0], span=union(noun.span, first.span)), mods[1:])
    return Noun(noun, mods)


def _is_on_new(predicate: Predicate) -> bool:
    """Return True for a place on or in a thing that is new, which does not tell known things apart: *on a mat*."""
    on = predicate.relation in ("on", "inside") and predicate.positive and not predicate.of_one
    things = predicate.arguments
    return on and "that" not in predicate.adverbs and len(things) == 1 and things[0].determiner in ("a", "an")


def _of_the_subject(noun: Noun) -> tuple[Noun, tuple[Predicate, ...]]:
    """Separate *with its spout pointing to the window* from a place: *its* is the subject's."""
    phrase = noun.phrase
    last = phrase.predicates[-1] if phrase.predicates else None
    part = last.subject_part if last is not None else None
    if part is None and last is not None and last.reversed and last.of_one:
        part = last.arguments[0]  # 'on the mat with its cable beside it'
    if last is None or part is None:
        return noun, ()
    own = part.owner is not None and part.owner.pronoun in ("it", "they")
    bare = part.determiner is None and part.plural and last_word(part.head) in AIMED_PARTS
    aimed = part.owner is None and (part.determiner == "the" or bare) and last.relation in ("facing", "pointing")
    if not own and not aimed:
        return noun, ()
    kept = phrase.predicates[:-1]
    return Noun(replace(phrase, predicates=kept, span=(phrase.span[0], last.span[0])), noun.extra), (last,)


def _of_the_thing_placed(noun: Noun) -> tuple[Noun, tuple[Predicate, ...]]:
    """Separate *on the same plate* from the thing that is there already: *beside the bread, on the same plate*."""
    phrase = noun.phrase
    last = phrase.predicates[-1] if phrase.predicates else None
    if last is None or last.relation not in ("on", "inside") or not any(a.determiner == "same" for a in last.arguments):
        return noun, ()
    bare = replace(phrase, predicates=phrase.predicates[:-1], span=(phrase.span[0], last.span[0]))
    return Noun(bare, noun.extra), (last,)


def _is_side(predicate: Predicate) -> bool:
    return predicate.relation in ("left", "right", "top", "bottom") and not predicate.arguments


def _places(relator: Relator, places: tuple[NounPhrase, ...], span: Span) -> list[Predicate]:
    """Return the predicates of several places, which share their object: *on the left side and top of X*."""
    of = next((member.of for member in places if member.of is not None), None)
    found = []
    for member in places:
        predicate = place(relator, replace(member, of=member.of or of, negated=False), span)
        if predicate is not None:
            found.append(replace(predicate, positive=not predicate.positive) if member.negated else predicate)
    return found


def _positioned(relator: Relator, phrase: NounPhrase, span: Span) -> Predicate | None:
    """Return the predicate of a place; *from the left* is an ordinal without its number."""
    relation = relator.preposition.relation
    if relation == "from" and is_place(phrase) and phrase.of is None and phrase.determiner not in ("a", "an"):
        side = (
            phrase.head
            if phrase.head != "end" and phrase.head != "side"
            else " ".join(a.word for a in phrase.adjectives)
        )
        return Predicate("ordinal", (), span, part=side)
    if (
        is_place(phrase)
        and phrase.predicates
        and relation not in ("on", "inside", "at", "to", "along", "from", "facing", "pointing")
    ):
        return None
    if (
        relation in ("facing", "pointing")
        and phrase.head in DIRECTION_WORDS
        and phrase.of is None
        and phrase.owner is None
    ):
        word = Adjective(" ".join((*directions_of(phrase), phrase.head)), "position", Degree.PLAIN, phrase.span)
        return Predicate(relation, (), span, value=word, adverbs=relator.adverbs, positive=relator.positive)
    return place(relator, phrase, span)


def _with_argument(main: Predicate, extra: tuple[Predicate, ...]) -> tuple[Predicate, tuple[Predicate, ...]]:
    """Join *to X*, *of X* and *relative to X* after a place without an owner: *at the top position to X*."""
    if extra and not main.arguments and extra[0].relation == "to" and main.relation != "ordinal":
        return replace(main, arguments=extra[0].arguments, span=union(main.span, extra[0].span)), extra[1:]
    return main, extra


def _properties(words: tuple[Adjective, ...]) -> tuple[Predicate, ...]:
    found = []
    for word in words:
        relation = word.dimension
        if word.dimension == "position" and word.word in (
            "left",
            "right",
            "top",
            "bottom",
            "middle",
            "near",
            "far",
            "front",
            "back",
        ):
            relation = {"front": "in_front", "back": "behind"}.get(word.word, word.word)
        elif word.dimension == "rank":
            relation = "ordinal"
        elif word.word in ("open", "empty"):
            relation = word.word
        elif word.word in ("parallel", "aligned", "stacked", "nested"):
            relation = {"parallel": "parallel_each_other"}.get(word.word, word.word)
        found.append(Predicate(relation, (), word.span, value=word, degree=word.degree, positive=word.positive))
    return tuple(found)


def _accompanied(relator: Relator, member: NounPhrase, span: Span) -> list[Predicate]:
    found = accompanied_by(member, span)
    if not relator.positive:
        found = [replace(p, positive=not p.positive) for p in found]
    return found


_NO_TARGETS = frozenset({"direction", "position", "area", "inside", "outside", "o'clock"})

_OBLIGING = frozenset({"should", "must", "need", "have to", "ought", "shall"})
"""Modal verbs of what must be done, and is not yet so."""
_OR = "or"
"""Mark, among the adverbs of a place, of an alternative to the place before it."""

_SHARING_PLACES = frozenset({"along with", "together with"})
"""Prepositions of a thing that is where the subject is: *the gloves are on the shelf, along with the goggles*."""

_TOWARDS = frozenset({"toward", "towards"})
_PARTS = frozenset({"tip", "end", "front", "back", "side", "top", "bottom", "edge"})


_LEVEL_RELATIONS = frozenset({"above", "below", "behind", "in_front", "under", "top", "bottom"})
_QUANTIFIERS = frozenset({"most", "many", "several", "few", "some", "half"})
_FASTENING = word_set(
    "attach fix secure fasten screw bolt nail tape glue tie strap clip clamp pin connect join wedge press push wrap"
    " mount install hold affix anchor hook lower raise lift pull drag turn spread pour stick scoop lock"
)
"""Commands in which *with* names a tool: *secure it with two bolts*."""
_KINDS = word_set("type kind sort variety assortment selection range choice")
"""Nouns of what the things after *of* are like or how many they are: *a selection of cheeses*."""
_RESTS = frozenset({"rest", "remainder", "bulk"})
"""Nouns of what is left of the things after *of*: *the rest of the spoons*."""
_FRACTIONS = frozenset({"half", "third", "quarter", "majority", "fifth"})
_OF_ITS_OWN = frozenset({"upside_down", "on", "inside"})
"""Relations that a relative clause states of its noun, and that a phrase may state of the subject before."""

_DIRECTIONS = frozenset({"left", "right", "in_front", "behind", "near", "next_to"})
"""Relations after whose known object a second place is the subject's."""

_SIDES = frozenset({"left", "right", "top", "bottom", "front", "back"})
_AMOUNTS = word_set(
    "length layer bed coat coating film drop splash dollop handful pinch spoonful knob drizzle dash dusting scattering"
    " heap mound bit amount quantity helping cm mm centimetre centimeter millimetre inch gram g kg ml litre liter"
)
"""Nouns of an amount, before the substance or the things that are meant."""
_LEVELS = frozenset({"plane", "level", "height", "line", "axis"})


_KNOWN = frozenset({"same", "usual", "right", "proper", "correct", "wrong", "appropriate"})
"""Adjectives of a place that is not named."""
_PICTURES = frozenset({"picture", "photo", "photograph", "image", "diagram", "video", "illustration", "drawing"})
_POINTED_AT = frozenset({"spot", "point", "place", "location", "stage"})
"""Nouns after *at that*, which go back to a place named before."""
_MEASURES = frozenset({"level", "height", "distance", "angle", "interval", "depth", "speed", "temperature", "pace"})
"""Nouns after *at* that measure: *at a comfortable working distance*."""

_OCCASIONS = word_set(
    "meal dinner lunch breakfast supper luncheon brunch concert performance ceremony wedding rehearsal time interval"
)
"""Nouns of what lasts or comes again, which nothing is in: *in a formal dinner*, *at equal intervals*."""
_RULES = frozenset({"rule", "law", "custom", "tradition", "method", "principle", "book"})
"""Nouns after which *by the* says how: *divide the desk by the rule of thirds*."""
_MANNERS = word_set(
    "value price brand theme subject author mistake default law tradition custom rule accident chance colour color size"
    " hand name age height type kind length weight shape date number order"
)
"""Nouns after which *by* says how and not where: *sorted by colour*."""

_HEIGHTS = {
    ("height", Degree.COMPARATIVE): {"low": "below", "high": "above"},
    ("top", Degree.PLAIN): {"top": "above"},
    ("bottom", Degree.PLAIN): {"bottom": "below"},
}


_SHARING = DIRECTION_RELATIONS | {"opposite", "next_to", "far", "along", "against"}
_ALIGNING = frozenset({"parallel", "perpendicular", "aligned", "level_with"})
"""Relations after a direction that has their object: *above and parallel to the plate*."""


_SHARED_FROM = frozenset({"around", "middle"})
"""Other relations whose object belongs to a place before them as well: *on or around X*, *above and in the middle*."""


def _is_group(phrase: NounPhrase) -> bool:
    """Return True for *a stack of books*, which names things and not their place."""
    return arrangement_of(phrase) is not None and phrase.of is not None


def _shared(made: list[tuple[str, tuple[Predicate, ...]]]) -> list[tuple[str, tuple[Predicate, ...]]]:
    """Give a place without an object that of its neighbour: *below and to the left of X*, *above X and to the left*."""
    for i, (link, predicates) in enumerate(made):
        if len(predicates) == 1 and (heights := _HEIGHTS.get((predicates[0].relation, predicates[0].degree))):
            word = predicates[0].value.word if predicates[0].value is not None else ""
            if word in heights and (i + 1 < len(made) or i):
                predicates = (replace(predicates[0], relation=heights[word], value=None, degree=Degree.PLAIN),)
        if len(predicates) != 1 or predicates[0].arguments or predicates[0].relation not in _SHARING:
            continue
        this = predicates[0]
        if i and made[i - 1][1] and made[i - 1][1][-1].relation == "diagonal":
            made[i] = (link, (replace(this, arguments=made[i - 1][1][-1].arguments),))
            made[i - 1] = (made[i - 1][0], made[i - 1][1][:-1])
            continue
        if this.part not in (None, "side") or this.relation == "corner":
            continue
        after = made[i + 1][1][0] if i + 1 < len(made) and made[i + 1][1] and made[i + 1][0] in ("and", "or") else None
        before = made[i - 1][1][0] if i and made[i - 1][1] and link in ("and", ",", "or") else None
        if after is not None and after.arguments and after.relation in _SHARING | _ALIGNING | _SHARED_FROM:
            made[i] = (link, (replace(this, arguments=after.arguments),))
        elif before is not None and len(before.arguments) == 1 and before.relation in _SHARING and not before.reversed:
            made[i] = (link, (replace(this, arguments=before.arguments),))
    return made


def viewpoint_of(predicates: tuple[Predicate, ...]) -> Viewpoint | None:
    """Return the viewpoint that predicates of *you* state: *you are facing the bed*, *standing at the door*.

    Parameters
    ----------
    predicates
        Predicates of the person who looks.

    Returns
    -------
    Viewpoint or None
        Place and direction of the viewer; None if the predicates name neither.
    """
    at = facing = back = None
    nested = [p for predicate in predicates for argument in predicate.arguments for p in argument.predicates]
    if (
        predicates
        and all(not p.relation.startswith(("facing", "from")) for p in predicates)
        and predicates[0].arguments
    ):
        at = predicates[0].arguments[0]
    for predicate in (*predicates, *(p for p in nested if p.relation in ("facing", "from"))):
        if not predicate.arguments:
            continue
        if predicate.relation in ("facing", "pointing"):
            facing = predicate.arguments[0]
        elif predicate.relation in (
            "from",
            "at",
            "near",
            "inside",
            "on",
            "in_front",
            "next_to",
            "opposite",
            "against",
            "middle",
            "end",
            "behind",
            "through",
            "side",
            "corner",
        ):
            at = at or predicate.arguments[0]
        elif predicate.relation == "with" and predicate.arguments[0].head == "back":
            back = next((p.arguments[0] for p in predicate.arguments[0].predicates if p.arguments), None)
        elif predicate.subject_part is not None and predicate.subject_part.head == "back":
            back = predicate.arguments[0]
    if at is None and facing is None and back is None:
        return None
    return Viewpoint((predicates[0].span[0], predicates[-1].span[1]), at=at, facing=facing, back=back)
