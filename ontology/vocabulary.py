"""The closed vocabulary: every IRI that code writes is a member here, so that a misspelt one fails at once.

A test compares the members with the TBox in both directions.
"""

from __future__ import annotations

from enum import StrEnum

BASE = "https://w3id.org/deixis/onto#"
ONTOLOGY_IRI = "https://w3id.org/deixis/onto"


class DX(StrEnum):
    """Terms of the Deixis ontology that code refers to by name.

    >>> DX.SCENE
    <DX.SCENE: 'https://w3id.org/deixis/onto#Scene'>
    >>> hasattr(DX, "SCEEN")
    False
    """

    # annotation properties that code reads from the TBox
    READING = BASE + "reading"
    ADMITS_ON_X = BASE + "admitsOnX"
    ADMITS_ON_Y = BASE + "admitsOnY"
    DECIDED_ON_Z = BASE + "decidedOnZ"
    ALLEN_SYMBOL = BASE + "allenSymbol"
    PHRASE = BASE + "phrase"
    RELATION = BASE + "relation"
    OUTLINE = BASE + "outline"
    LEAST_LENGTH = BASE + "leastLength"
    TYPICAL_LENGTH = BASE + "typicalLength"
    GREATEST_LENGTH = BASE + "greatestLength"
    LEAST_WIDTH = BASE + "leastWidth"
    TYPICAL_WIDTH = BASE + "typicalWidth"
    GREATEST_WIDTH = BASE + "greatestWidth"
    LEAST_HEIGHT = BASE + "leastHeight"
    TYPICAL_HEIGHT = BASE + "typicalHeight"
    GREATEST_HEIGHT = BASE + "greatestHeight"
    # readings
    WIDE = BASE + "wide"
    EXACT = BASE + "exact"
    # classes
    ALLEN_RELATION = BASE + "AllenRelation"
    HEDGE = BASE + "Hedge"
    THING = BASE + "Thing"
    SCENE = BASE + "Scene"
    VIEWPOINT = BASE + "Viewpoint"
    PERCEIVED_OBJECT = BASE + "PerceivedObject"
    LAYOUT = BASE + "Layout"
    ROLE = BASE + "Role"
    RELATION_STATEMENT = BASE + "RelationStatement"
    # properties
    HEDGE_WEIGHT = BASE + "hedgeWeight"
    SPATIAL_RELATION = BASE + "spatialRelation"
    DIRECTION = BASE + "direction"
    SUPPORT = BASE + "support"
    FILLS = BASE + "fills"
    SHOWS = BASE + "shows"
    IN_SCENE = BASE + "inScene"
    SEEN_FROM = BASE + "seenFrom"
    IDENTIFIER = BASE + "identifier"
    PERCEIVED_LABEL = BASE + "perceivedLabel"
    CONFIDENCE = BASE + "confidence"
    FRAME = BASE + "frame"
    UNIT = BASE + "unit"
    MIN_X = BASE + "minX"
    MIN_Y = BASE + "minY"
    MIN_Z = BASE + "minZ"
    MAX_X = BASE + "maxX"
    MAX_Y = BASE + "maxY"
    MAX_Z = BASE + "maxZ"
    SUBJECT = BASE + "subject"
    OBJECT = BASE + "object"
    POSITIVE = BASE + "positive"
    OPTIONAL = BASE + "optional"
    WEIGHT = BASE + "weight"
    ATOM = BASE + "atom"
    STATED_AT = BASE + "statedAt"
    LINE = BASE + "line"
    POSITION = BASE + "position"
    KIND_DECLARED = BASE + "kindDeclared"
    DESCRIBED_FROM = BASE + "describedFrom"
    IN_LAYOUT = BASE + "inLayout"
    OF_KIND = BASE + "ofKind"
    INTERCHANGEABLE_WITH = BASE + "interchangeableWith"
    LESSON = BASE + "Lesson"
    MATCH = BASE + "Match"
    LEARNED_IN = BASE + "learnedIn"
    CATEGORY = BASE + "category"
    OF_ROLE = BASE + "ofRole"
    PERCEIVED_AS = BASE + "perceivedAs"
    COULD_BE = BASE + "couldBe"
    DECIDED = BASE + "decided"
    SCORE = BASE + "score"
    ENGINE = BASE + "engine"
    PROVED_BEST = BASE + "provedBest"
    SOFTWARE_VERSION = BASE + "softwareVersion"
    SCRIPT_FILE = BASE + "scriptFile"
    SCRIPT_TEXT = BASE + "scriptText"
    SCENE_TEXT = BASE + "sceneText"
    RELATION_MODEL = BASE + "RelationModel"
    MODEL_TERM = BASE + "ModelTerm"
    TERM_OF = BASE + "termOf"
    MODEL_NAME = BASE + "modelName"
    OUTLIER_RATE = BASE + "outlierRate"
    CHANCE_DEGREE = BASE + "chanceDegree"
    EXAMPLE_COUNT = BASE + "exampleCount"
    FEATURE = BASE + "feature"
    KNOTS = BASE + "knots"
    LOG_DEGREES = BASE + "logDegrees"
    TREND = BASE + "trend"


class W3C(StrEnum):
    """The terms of RDF, RDFS, OWL and SKOS that code refers to."""

    RDF_TYPE = "http://www.w3.org/1999/02/22-rdf-syntax-ns#type"
    RDFS_LABEL = "http://www.w3.org/2000/01/rdf-schema#label"
    RDFS_SUB_CLASS_OF = "http://www.w3.org/2000/01/rdf-schema#subClassOf"
    RDFS_SUB_PROPERTY_OF = "http://www.w3.org/2000/01/rdf-schema#subPropertyOf"
    OWL_CLASS = "http://www.w3.org/2002/07/owl#Class"
    OWL_INVERSE_OF = "http://www.w3.org/2002/07/owl#inverseOf"
    OWL_TRANSITIVE_PROPERTY = "http://www.w3.org/2002/07/owl#TransitiveProperty"
    SKOS_ALT_LABEL = "http://www.w3.org/2004/02/skos/core#altLabel"
    SKOS_DEFINITION = "http://www.w3.org/2004/02/skos/core#definition"
    OWL_RESTRICTION = "http://www.w3.org/2002/07/owl#Restriction"
    OWL_ON_PROPERTY = "http://www.w3.org/2002/07/owl#onProperty"
    OWL_SOME_VALUES_FROM = "http://www.w3.org/2002/07/owl#someValuesFrom"
    DCTERMS_TITLE = "http://purl.org/dc/terms/title"
    DCTERMS_SOURCE = "http://purl.org/dc/terms/source"


class PROV(StrEnum):
    """The terms of PROV-O that code refers to."""

    ACTIVITY = "http://www.w3.org/ns/prov#Activity"
    ENTITY = "http://www.w3.org/ns/prov#Entity"
    SOFTWARE_AGENT = "http://www.w3.org/ns/prov#SoftwareAgent"
    USED = "http://www.w3.org/ns/prov#used"
    WAS_DERIVED_FROM = "http://www.w3.org/ns/prov#wasDerivedFrom"
    WAS_GENERATED_BY = "http://www.w3.org/ns/prov#wasGeneratedBy"
    WAS_ASSOCIATED_WITH = "http://www.w3.org/ns/prov#wasAssociatedWith"
    STARTED_AT_TIME = "http://www.w3.org/ns/prov#startedAtTime"
    ENDED_AT_TIME = "http://www.w3.org/ns/prov#endedAtTime"
