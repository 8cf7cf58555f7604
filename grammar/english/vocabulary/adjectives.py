"""Adjectives by the dimension that they tell, such as colour, size and material, and their degrees."""

from __future__ import annotations

from functools import cache

from deixis.grammar.english.tree import Degree
from deixis.grammar.english.vocabulary.tables import table, word_set

_ADJECTIVES = """
colour: red, green, blue, yellow, orange, purple, violet, pink, brown, black, white, grey, gray, beige, tan, cream
colour: turquoise, teal, maroon, navy, silver, gold, golden, bronze, light, dark, pale, bright, whitish, blackish
colour: brownish, greyish, grayish, reddish, greenish, bluish, yellowish, cyan, magenta, lime, olive, khaki, ivory
colour: mauve, burgundy, charcoal, aqua, indigo, lavender, peach, colored, coloured, multicolored, colorful, colourful
colour: creme, off-white, blonde, chocolate, mahogany, transparent, clear, opaque, shiny, dull, matte, glossy, blueish
size: big, bigger, biggest, large, larger, largest, small, smaller, smallest, little, littler, littlest, tiny, huge
size: medium, mini, giant, massive, enormous, medium-sized, full-size, oversized, compact, average, regular, mid-sized
size: full-sized, miniature, petite, great, full
height: tall, taller, tallest, short, shorter, shortest, high, higher, highest, low, lower, lowest
length: long, longer, longest
width: wide, wider, widest, narrow, narrower, narrowest, broad, broader, broadest
thickness: thick, thicker, thickest, thin, thinner, thinnest, slim, slimmer, slimmest, skinny, skinnier, skinniest
thickness: fat, fatter, fattest, deep, deeper, deepest, shallow
material: wooden, wood, metal, metallic, plastic, glass, leather, steel, stainless, brass, copper, iron, aluminium
material: aluminum, ceramic, porcelain, brick, stone, marble, granite, concrete, wicker, fabric, cloth, cotton, woollen
material: woolen, linen, velvet, tiled, cardboard, oak, pine, upholstered, rubber, tin, clay, wood-grain, suede
shape: round, rounded, square, rectangular, rectangle, circular, oval, triangular, curved, straight, flat, cylindrical
shape: l-shaped, u-shaped, boxy, conical, cubic, hexagonal, octagonal, spherical, pointed, pointy, cube-shaped, bent
position: left, right, top, bottom, upper, lower, middle, central, center, centre, front, back, rear, near, far, outer
position: downstage, upstage
position: inner, leftmost, rightmost, topmost, bottommost, uppermost, lowermost, left-hand, right-hand, lefthand
position: righthand, centermost, middlemost, outermost, innermost, foremost, hindmost, inside, outside, opposite
position: outermost, lefthanded, righthanded, near-side, far-side, overhead, nearest, closest, farthest, furthest, next
position: closer, nearer, farther, further, adjacent, distant, northern, southern, eastern, western, isolated, close
position: frontmost, rearmost, backmost, extreme
state: open, opened, closed, shut, empty, full, broken, clean, dirty, wet, dry, lit, unlit, new, old, older, newer
state: folded, unfolded, rolled, made, unmade, messy, tidy, neat, upright, vertical, horizontal, diagonal, tilted
state: upside-down, inverted, nested, stacked, empty-handed, visible, hidden, half-open, half-closed, unopened, bare
state: dead, crooked, rotated, slanted, sideways, freestanding, standalone, free-standing, stand-alone, loose, lone
state: framed, padded, cushioned, striped, patterned, checkered, plaid, floral, solid, plain, dotted, worn, used, unused
state: uncovered, parallel, perpendicular, stationary, askew, slim-line, ajar, level
count: few, fewer, fewest
other: same, different, similar, identical, single, double, twin, sole, alone, separate, individual, only, whole, entire
other: correct, right, wrong, particular, specific, certain, nice, pretty, comfy, comfortable, soft, hard, heavy, light
other: modern, fancy, ornate, decorative, typical, normal, usual, additional, extra, remaining, various, visible, own
other: immediate, direct, weird, strange, odd, funny, unusual, regular, standard, equal, interesting, exact, last, final
other: distinct, matching, opposite, electric, digital, electronic, industrial, domestic, personal, available, real
other: nearby, original, desired, existing, accessible, reachable, appropriate, proper, necessary, required, important
other: useful, helpful, handy, convenient, ideal, perfect, lovely, beautiful, attractive, elegant, daily, weekly
other: sturdy, steady, firm, rigid, robust, suitable, corresponding, respective, designated
other: warm, hot, cold, fresh, large-scale, such, actual, prominent, noticeable, obvious, lefty, empty, busy, ergonomic
"""

_MATERIAL_NOUNS = word_set(
    "wood metal plastic glass leather steel brass copper iron brick stone marble granite concrete fabric cloth cotton"
    " linen velvet cardboard oak pine rubber tin clay"
)

COLOUR_SHADES = frozenset({"light", "dark", "pale", "bright", "deep", "medium", "off"})


QUALITIES = word_set(
    "easy easier difficult simple ready able unable essential possible impossible likely unlikely common traditional"
    " formal informal casual good excellent true false accurate sure invisible special unique rare ordinary basic"
    " previous current recent damp moist strong weak stable rough smooth sharp blunt quiet loud crowded cluttered safe"
    " dangerous risky careful gentle quick fast slow bulky foldable removable adjustable optional seasonal ornamental"
    " functional practical cozy cosy rustic festive cheap expensive free complete partial external internal indoor"
    " outdoor automatic raw ripe frozen salty spicy hungry thirsty tired happy sad angry afraid proud famous"
    " popular alive sick healthy flexible fragile delicate breakable precious valuable worthless hollow uneven"
    " symmetrical asymmetrical convex concave wavy spotted translucent lightweight waterproof airtight concentric"
    " oblique frequent occasional permanent temporary tight snug slack ample enough sufficient adequate scarce abundant"
    " limited minimal moderate excessive fragrant scented perishable edible drinkable acceptable desirable preferable"
    " advisable customary conventional courteous polite rude sacred ancient medieval unstable unsafe uncomfortable"
    " inconvenient unnecessary inaccessible awkward clumsy graceful tricky complicated complex intricate elaborate"
    " luxurious sumptuous lavish modest humble striking dramatic vivid subtle muted subdued vibrant lively"
    " cheerful gloomy dim dusky sunny cloudy rainy windy chilly cool lukewarm tepid icy frosty steamy humid arid"
    " tangy pungent savoury sugary creamy crunchy crispy crumbly chewy juicy tender tough bland"
    " tasty delicious appetising appetizing inedible nutritious leafy grassy mossy woody thorny prickly fluffy furry"
    " hairy fuzzy silky velvety sticky slippery greasy oily soapy muddy dusty grimy filthy spotless immaculate pristine"
    " shabby worn-out threadbare tattered dilapidated derelict decrepit antiquated obsolete outdated old-fashioned"
    " contemporary up-to-date brand-new secondhand second-hand hand-made handmade homemade store-bought man-made"
    " artificial synthetic genuine authentic fake"
    " wealthy poor rich affluent needy generous stingy cruel friendly hostile gracious welcoming inviting"
    " charming delightful pleasant unpleasant enjoyable boring tedious exciting thrilling amazing wonderful"
    " fantastic terrific marvelous marvellous splendid magnificent superb gorgeous stunning ugly hideous"
    " tacky stylish trendy fashionable chic sleek sophisticated refined posh classy quirky whimsical playful"
    " serious solemn dignified stately majestic regal royal holy blessed divine spiritual secular"
    " careless reckless cautious patient impatient eager keen willing reluctant lazy diligent industrious"
    " clever smart intelligent wise foolish silly stupid crazy insane sane sober drunk awake asleep conscious"
    " deaf mute lame disabled pregnant youthful mature immature"
    " brave bold shy timid nervous anxious calm peaceful serene tranquil restless hectic chaotic orderly"
    " disorganized disorganised uncluttered spacious roomy airy"
    " wide-open secluded remote faraway proximate contiguous"
    " unobstructed obstructed intact defective faulty flawless imperfect incomplete unfinished"
    " protruding flush unattached loose-fitting tight-fitting"
    " rickety wobbly shaky bulging slender chunky hefty weighty"
    " foldaway collapsible movable moveable immovable immobile reversible"
    " interchangeable compatible incompatible versatile specialised specialized"
    " relevant irrelevant applicable crucial vital critical significant insignificant trivial negligible"
    " obligatory mandatory compulsory voluntary intentional accidental deliberate random arbitrary"
    " approximate precise inaccurate imprecise proportional proportionate disproportionate consistent inconsistent"
    " homogeneous heterogeneous diverse"
    " eventual imminent forthcoming"
    " toxic poisonous harmful harmless hazardous flammable inflammable combustible corrosive caustic"
    " sterile unsterile contaminated infectious hygienic unhygienic sanitary unsanitary"
    " brittle supple pliable malleable stretchy stiff inflexible unyielding porous impermeable watertight"
    " odorless odourless colorless colourless tasteless flavorful flavourful aromatic"
    " noisy silent soundless deafening audible inaudible legible illegible readable unreadable recognisable"
    " recognizable identifiable distinguishable indistinguishable conspicuous inconspicuous unnoticeable"
    " unsuitable inappropriate improper incorrect invalid untrue bogus dubious doubtful questionable"
    " lawful unlawful legal illegal ethical unethical moral immoral"
    " eligible ineligible responsible irresponsible dependent independent reliable unreliable trustworthy"
    " grateful thankful ungrateful hopeful hopeless helpless useless pointless meaningless meaningful purposeful"
    " absolute ultimate utter sheer mere"
    " asymmetric symmetric angular oblong elongated tapered tapering rimless handleless stemless lidless footed"
    " ready-made ready-to-use self-contained easy-to-reach hard-to-reach eye-catching time-consuming labour-intensive"
    " labor-intensive space-saving long-lasting short-lived well-lit well-worn well-made well-organized well-organised"
    " low-lying high-end low-end high-quality low-quality top-notch top-heavy right-handed left-handed ambidextrous"
    " unlucky lucky fortunate unfortunate auspicious inauspicious"
)
"""Qualities that are not things by themselves: *it is easy to reach*. Before a noun they are part of its name.

A thing is told apart by its name, so that *the sharp knife* and *the blunt knife* are two things.
"""

EMPTY = frozenset({"empty", "bare", "clear"})
"""Words for what has nothing on it or in it."""

_IRREGULAR_DEGREES = {
    "better": ("good", Degree.COMPARATIVE),
    "best": ("good", Degree.SUPERLATIVE),
    "further": ("far", Degree.COMPARATIVE),
    "farther": ("far", Degree.COMPARATIVE),
    "furthest": ("far", Degree.SUPERLATIVE),
    "farthest": ("far", Degree.SUPERLATIVE),
    "nearest": ("near", Degree.SUPERLATIVE),
    "nearer": ("near", Degree.COMPARATIVE),
    "closest": ("near", Degree.SUPERLATIVE),
    "closer": ("near", Degree.COMPARATIVE),
    "close": ("near", Degree.PLAIN),
    "leftmost": ("left", Degree.SUPERLATIVE),
    "rightmost": ("right", Degree.SUPERLATIVE),
    "topmost": ("top", Degree.SUPERLATIVE),
    "uppermost": ("top", Degree.SUPERLATIVE),
    "bottommost": ("bottom", Degree.SUPERLATIVE),
    "lowermost": ("bottom", Degree.SUPERLATIVE),
    "centermost": ("middle", Degree.SUPERLATIVE),
    "middlemost": ("middle", Degree.SUPERLATIVE),
    "outermost": ("outer", Degree.SUPERLATIVE),
    "innermost": ("inner", Degree.SUPERLATIVE),
    "foremost": ("front", Degree.SUPERLATIVE),
    "frontmost": ("front", Degree.SUPERLATIVE),
    "hindmost": ("back", Degree.SUPERLATIVE),
    "rearmost": ("back", Degree.SUPERLATIVE),
    "backmost": ("back", Degree.SUPERLATIVE),
    "upper": ("top", Degree.PLAIN),
    "left-hand": ("left", Degree.PLAIN),
    "lefthand": ("left", Degree.PLAIN),
    "right-hand": ("right", Degree.PLAIN),
    "righthand": ("right", Degree.PLAIN),
    "center": ("middle", Degree.PLAIN),
    "centre": ("middle", Degree.PLAIN),
    "central": ("middle", Degree.PLAIN),
    "rear": ("back", Degree.PLAIN),
    "extreme": ("far", Degree.PLAIN),
    "gray": ("grey", Degree.PLAIN),
    "larger": ("large", Degree.COMPARATIVE),
    "largest": ("large", Degree.SUPERLATIVE),
    "littler": ("little", Degree.COMPARATIVE),
    "littlest": ("little", Degree.SUPERLATIVE),
}


@cache
def adjectives() -> dict[str, str]:
    """Return the dimension of each adjective; of two dimensions the first of the table counts."""
    found: dict[str, str] = {}
    for dimension, words in table(_ADJECTIVES).items():
        for word in words:
            found.setdefault(word, dimension)
    return found


def is_material_noun(word: str) -> bool:
    """Return True for a noun that names a material before another noun: *glass table*.

    Parameters
    ----------
    word
        Word in lower case.

    Returns
    -------
    bool
        False for a material that only has an adjective, such as *wooden*.
    """
    return word in _MATERIAL_NOUNS


_TOOLS = frozenset({"creamer", "opener", "cleaner", "dryer", "shutter", "hotter", "topper"})
"""Nouns that look like the comparative of an adjective."""


@cache
def degree_of(word: str) -> tuple[str, Degree]:
    """Return the lemma and the degree of an adjective.

    >>> degree_of("tallest"), degree_of("bigger"), degree_of("leftmost")[0]
    (('tall', <Degree.SUPERLATIVE: 'superlative'>), ('big', <Degree.COMPARATIVE: 'comparative'>), 'left')
    """
    irregular = _IRREGULAR_DEGREES.get(word)
    if irregular is not None:
        return irregular
    if word in _TOOLS:
        return word, Degree.PLAIN
    known = adjectives()
    for ending, degree in (("est", Degree.SUPERLATIVE), ("er", Degree.COMPARATIVE)):
        if word.endswith(ending):
            stem = word[: -len(ending)]
            for lemma in (stem, stem + "e", stem[:-1], stem[:-1] + "y"):
                if (
                    len(lemma) > 1
                    and lemma in known
                    and (lemma != stem[:-1] + "y" or stem.endswith("i"))  # 'happier', and not 'grater' of 'gray'
                    and not (lemma == stem[:-1] and stem[-1:] not in (*stem[-2:-1], "i"))
                ):
                    return lemma, degree
    return word, Degree.PLAIN


def is_adjective(word: str) -> bool:
    """Return True for an adjective that the tables hold, in any degree, or that has the ending of one.

    Parameters
    ----------
    word
        Word in lower case.

    Returns
    -------
    bool
        False for the name of a tool that looks like a comparative.
    """
    if word in _TOOLS:
        return False
    if word in adjectives() or degree_of(word)[1] is not Degree.PLAIN:
        return True
    if word.startswith("un") and word[2:] in adjectives():
        return True
    return word.endswith(("-shaped", "-colored", "-coloured", "-sized", "-looking", "colored", "coloured", "shaped"))


COMPARISONS = {
    "big": "bigger",
    "large": "bigger",
    "small": "smaller",
    "little": "smaller",
    "tall": "taller",
    "high": "above",
    "short": "shorter",
    "low": "below",
    "long": "longer",
    "wide": "wider",
    "broad": "wider",
    "narrow": "narrower",
    "thick": "thicker",
    "thin": "thinner",
}
"""Relation of a comparison by the lemma of its adjective; a missing one is ``more`` with the adjective as its value."""
