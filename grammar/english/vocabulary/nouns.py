"""Nouns that play a special part in a description: surfaces, people, surroundings, containers, substances, parts."""

from __future__ import annotations

from deixis.grammar.english.vocabulary.tables import word_set

SURFACES = frozenset(
    [
        "table",
        "tabletop",
        "desk",
        "desktop",
        "tray",
        "counter",
        "countertop",
        "worktop",
        "bench",
        "workbench",
        "sideboard",
        "shelf",
        "windowsill",
        "sill",
        "blanket",
        "groundsheet",
        "rug",
        "floor",
        "ground",
        "tablecloth",
        "dresser",
        "surface",
        "mantelpiece",
        "ledge",
        "nightstand",
        "placemat",
        "cabinet",
        "buffet",
        "altar",
        "lawn",
        "sand",
        "bar",
        "cart",
        "trolley",
        "island",
        "top",
    ]
)
"""Nouns of things that other things are laid out on."""

FIGURES = word_set(
    "baby child infant doll puppet figure figurine statue saint king queen prince princess angel dog cat horse cow"
    " donkey ox sheep lamb rabbit mouse bird robot dinosaur dragon knight"
)
"""Nouns of figures and animals, which can have a name, and which *he* and *she* can stand for."""

PEOPLE = word_set(
    "person people individual guest diner inspector viewer reader user host waiter cook chef student teacher customer"
    " visitor man woman child boy girl mother father sister brother wife husband friend colleague passenger player"
    " captain scout bartender barkeeper operator assistant owner neighbour neighbor everybody everyone someone lady"
    " gentleman kid baby boss nurse patient doctor dentist maid secretary daughter son mum mom dad grandma grandmother"
    " grandfather grandpa aunt uncle cousin family crew staff member volunteer officer clerk client priest celebrant"
    " apprentice trainee technician mechanic tailor baker steward porter voter referee opponent audience congregation"
    " manager supervisor tenant landlord resident carer midwife surgeon therapist vet farmer gardener hairdresser"
    " barber musician singer soloist conductor photographer painter artist sculptor potter pupil bride groom arbiter"
    " librarian plumber electrician carpenter butcher grocer cashier follower worshipper parishioner novice newcomer"
    " beginner stranger drummer guitarist pianist waitress eater writer actor builder barista hostess"
    " rower climber hiker toddler sailor soldier sergeant jeweller stylist shopkeeper seller buyer vendor"
    " engineer scientist chemist researcher umpire goalkeeper bowler batter swimmer cyclist dealer instructor"
    " presenter lecturer participant attendee leader dancer magician juggler organist violinist percussionist"
)
"""Nouns of people, who are not objects of the scene."""

ABSTRACT = frozenset(
    [
        "decision",
        "question",
        "idea",
        "issue",
        "topic",
        "argument",
        "agreement",
        "discussion",
        "debate",
        "proposal",
        "luck",
        "emphasis",
        "attention",
        "responsibility",
        "opinion",
        "event",
        "story",
        "tale",
        "joke",
        "dream",
        "day",
        "week",
        "month",
        "year",
        "past",
        "future",
        "hope",
        "doubt",
        "reason",
        "fact",
        "name",
        "initial",
        "title",
        "date",
        "trace",
        "price",
        "cost",
        "value",
        "age",
        *("layout", "setup", "description", "instruction", "method", "procedure", "purpose"),
        *("blame", "pressure", "trust", "faith", "company", "care", "help", "thanks", "welcome"),
        *("trick", "advantage", "difficulty", "problem", "mistake", "effect", "mood", "atmosphere", "smell", "noise"),
        *(
            "ease",
            "convenience",
            "comfort",
            "placement",
            "exception",
            "preference",
            "highlight",
            "elegance",
            "efficiency",
        ),
        *("silence", "weather", "tradition", "custom", "history", "law", "risk", "danger", "chance", "news"),
        *("etiquette", "theory", "principle", "practice", "style", "variety", "restriction", "reference", "excerpt"),
    ]
)
"""Nouns of what has no place in a scene: *the decision on the table*."""

SURROUNDINGS = frozenset(
    [
        "wall",
        "window",
        "door",
        "room",
        "ceiling",
        "house",
        "garden",
        "kitchen",
        "office",
        "bathroom",
        "bedroom",
        "oak",
        "tree",
        "sun",
        "light",
        "entrance",
        "exit",
        "street",
        "corner",
        "aisle",
        "oven",
        "sink",
        "stove",
        "fridge",
        "outside",
        "inside",
        "north",
        "south",
        "east",
        "west",
        "socket",
    ]
)
"""Nouns of places around a table: they give directions, and are objects only if they have another description."""

VIEWER = "viewer"
"""Name of the person who looks at the scene: *me*, *you*, *the viewer*."""

VIEWER_WORDS = frozenset({"me", "i", "you", "we", "us", "myself", "yourself"})

EVENTS = frozenset(
    ["shift", "class", "lesson", "service", "show", "rehearsal", "session", "game", "match", "meeting", "meal",
     "dinner", "lunch", "breakfast", "supper", "concert", "performance", "ceremony", "wedding", "opening", "closing",
     "visit", "arrival", "departure", "exam", "trip", "journey", "use", "school", "work", "bedtime"]
)  # fmt: skip
"""Nouns of events, before and after which is a time."""

PLACES_OF = frozenset({"home", "place", "spot", "position", "location"})
"""Nouns of the place of a thing, of which a place is that of the thing: *the place of the jug is on the shelf*."""

GENERAL = frozenset(
    ["thing", "object", "item", "stuff", "something", "anything", "everything", "piece", "element", "one"]
)
"""Nouns that stand for an object of any kind."""

GROUPS = frozenset(
    [
        "row",
        "line",
        "group",
        "pair",
        "set",
        "couple",
        "stack",
        "pile",
        "circle",
        "ring",
        "column",
        "cluster",
        "array",
        "bunch",
        "trio",
        "series",
        "dozen",
    ]
)
"""Nouns that gather the objects of their *of* phrase: *a row of pawns*."""

PAIRED = frozenset(
    [
        "boot",
        "shoe",
        "sock",
        "glove",
        "slipper",
        "candlestick",
        "sandal",
        "earring",
        "skate",
        "ski",
        "cufflink",
        "trainer",
        "sneaker",
    ]
)
"""Nouns of things that come in twos: a plural without a number means two of them."""

SINGLE_PLURALS = frozenset(
    [
        "glasses",
        "scissors",
        "pliers",
        "tweezers",
        "tongs",
        "chopsticks",
        "spectacles",
        "headphones",
        "binoculars",
        "trousers",
        "shorts",
        "jeans",
        "keys",
        "matches",
        "goggles",
        "earphones",
        "sunglasses",
        "nippers",
        "shears",
        "clippers",
        "compasses",
        "scales",
        "pincers",
        "forceps",
        "pyjamas",
    ]
)
"""Plurals that name one thing, or things that lie together as one."""
SPECTACLES = frozenset({"pair", "my", "your", "his", "her", "reading", "sun", "safety", "folded", "prescription"})
"""Words before *glasses* that make them spectacles."""

HEADED = frozenset(
    [
        "fork",
        "knife",
        "spoon",
        "teaspoon",
        "tablespoon",
        "ladle",
        "spatula",
        "whisk",
        "brush",
        "toothbrush",
        "paintbrush",
        "hairbrush",
        "hammer",
        "mallet",
        "screwdriver",
        "chisel",
        "axe",
        "hatchet",
        "broom",
        "mop",
        "racket",
        "scoop",
        "shovel",
        "trowel",
        "spreader",
        "dipper",
        "scraper",
        "rake",
    ]
)
"""Long tools with a head and a handle at opposite ends: they point where their head is."""

SUBSTANCES = frozenset(
    [
        "coffee",
        "tea",
        "water",
        "milk",
        "juice",
        "wine",
        "beer",
        "acid",
        "base",
        "sugar",
        "salt",
        "pepper",
        "flour",
        "rice",
        "oil",
        "vinegar",
        "soup",
        "sauce",
        "ketchup",
        "mustard",
        "mayonnaise",
        "honey",
        "jam",
        "butter",
        "waste",
        "soil",
        "sand",
        "ink",
        "glue",
        "paint",
        "soap",
        "shampoo",
        "detergent",
        "cream",
        "lemonade",
        "cola",
        "gin",
        "rum",
        "vodka",
        "whisky",
        "tonic",
        "syrup",
        "ice",
        "stock",
        "broth",
        "batter",
        "dough",
        "cocoa",
        "cinnamon",
        "cereal",
        "muesli",
        "yoghurt",
        "yogurt",
        "gravy",
        "solvent",
        "ethanol",
        "indicator",
        "reagent",
        "buffer",
        "cheese",
        "ginger",
        "wasabi",
        "soya",
    ]
)
"""Mass nouns: a substance in a vessel is seen as the vessel."""

VESSELS = frozenset(
    [
        "bag",
        "bottle",
        "bowl",
        "box",
        "bucket",
        "can",
        "canister",
        "carafe",
        "carton",
        "case",
        "cup",
        "decanter",
        "dish",
        "flask",
        "glass",
        "jar",
        "jug",
        "jigger",
        "kettle",
        "mug",
        "packet",
        "pan",
        "pitcher",
        "pot",
        "shaker",
        "sachet",
        "tin",
        "tub",
        "tube",
        "tumbler",
        "vase",
        "vial",
        "beaker",
        "thermos",
        "cylinder",
        "crock",
        "tank",
        "basin",
    ]
)
"""Nouns of things that hold a substance."""

SUPPORTS = frozenset(
    [
        "saucer", "plate", "platter", "tray", "mat", "coaster", "napkin", "board", "slate", "cloth", "stand", "shelf",
        "table", "doily", "tile", "tier", "platform", "plinth", "pedestal", "easel", "trivet", "peg", "hook", "nail",
        "hanger", "stack", "pile",
    ]
)  # fmt: skip
"""Nouns of things that others stand on or hang from."""

HOLDERS = frozenset(
    [
        "drawer", "pocket", "compartment", "holder", "rack", "basket", "bin", "slot", "pouch", "sleeve", "holster",
        "crate", "chest", "cupboard", "folder", "envelope", "block", "kit", "hole", "satchel", "purse", "suitcase",
        "glovebox", "locker", "wardrobe", "closet", "fridge", "freezer", "safe", "sack", "wallet", "quiver", "sheath",
        "scabbard", "cage", "hutch", "niche", "alcove", "pigeonhole", "backpack", "rucksack", "handbag", "briefcase",
    ]
)  # fmt: skip
"""Nouns of things, other than vessels, that things are inside of."""

GAPS = frozenset({"gap", "space", "distance", "room"})
"""Nouns of what is between things, which is not a thing."""

FRONTS = frozenset(
    {
        "display",
        "dial",
        "lens",
        "logo",
        "opening",
        "writing",
        "picture",
        "window",
        "keyhole",
        "zipper",
        "print",
        "crest",
    }
)
"""Nouns that, without an article, stand for the front of the thing before: *timer on the rack, display facing you*."""

REMOVABLE = frozenset(
    {"door", "lid", "cap", "label", "stick", "drawer", "cable", "cord", "strap", "base", "screen", "hinge", "leg"}
)
"""Parts that can lie apart from their thing."""

AIMED_PARTS = {
    **dict.fromkeys(("blade", "edge"), "facing"),
    **dict.fromkeys(("tine", "prong", "tip", "bowl", "spout", "nib", "mouth", "screen", "handle"), "pointing"),
}
"""Parts that are said to be *to* what they point at, and the relation of their thing to it."""

PARTS = frozenset(
    [
        "handle",
        "lid",
        "spout",
        "blade",
        "rim",
        "base",
        "neck",
        "mouth",
        "opening",
        "label",
        "cap",
        "stem",
        "side",
        "edge",
        "end",
        "corner",
        "tip",
        "tine",
        "point",
        "toe",
        "heel",
        "sole",
        "leg",
        "arm",
        "back",
        "front",
        "top",
        "bottom",
        "screen",
        "cord",
        "cable",
        "hinge",
        "lip",
        "fold",
        "crease",
        "foot",
        "head",
        "shaft",
        "brim",
        "strap",
        "zip",
        "drawer",
        "door",
        "tail",
        "stick",
        "bristle",
        "prong",
        "nozzle",
        "face",
        "half",
    ]
)
"""Nouns of parts: with an owner they are not objects of their own (*its handle*, *the cup's rim*)."""


def last_word(noun: str) -> str:
    """Return the head noun of a compound: ``board`` of ``cutting board``.

    Parameters
    ----------
    noun
        Noun or compound.

    Returns
    -------
    str
        Last word that is not a number (*box* of *box 3*); empty for an empty noun.
    """
    first, _, last = noun.rpartition(" ")
    return last_word(first) if first and last.isdigit() else last
