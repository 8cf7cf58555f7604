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
    SUBJECT = BASE + "subject"
    OBJECT = BASE + "object"
    POSITIVE = BASE + "positive"
    OPTIONAL = BASE + "optional"
    WEIGHT = BASE + "weight"
    ATOM = BASE + "atom"
    STATED_AT = BASE + "statedAt"


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
