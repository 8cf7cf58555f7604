"""The terms of RDF, RDFS and OWL 2 that reasoning reads, each in its N-Triples spelling."""

from __future__ import annotations

PREFIXES = {
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "owl": "http://www.w3.org/2002/07/owl#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}


def term(name: str) -> str:
    """The term that a prefixed name stands for.

    >>> term("rdfs:label")
    '<http://www.w3.org/2000/01/rdf-schema#label>'
    """
    prefix, _, local = name.partition(":")
    return f"<{PREFIXES[prefix]}{local}>"


TYPE = term("rdf:type")
FIRST, REST, NIL = term("rdf:first"), term("rdf:rest"), term("rdf:nil")
LABEL = term("rdfs:label")
SUB_CLASS_OF, SUB_PROPERTY_OF = term("rdfs:subClassOf"), term("rdfs:subPropertyOf")
DOMAIN, RANGE = term("rdfs:domain"), term("rdfs:range")
THING, NOTHING, CLASS = term("owl:Thing"), term("owl:Nothing"), term("owl:Class")
EQUIVALENT_CLASS, EQUIVALENT_PROPERTY = term("owl:equivalentClass"), term("owl:equivalentProperty")
DISJOINT_WITH, COMPLEMENT_OF = term("owl:disjointWith"), term("owl:complementOf")
SAME_AS, DIFFERENT_FROM = term("owl:sameAs"), term("owl:differentFrom")
IMPORTS, ONTOLOGY = term("owl:imports"), term("owl:Ontology")
MEMBERS, DISTINCT_MEMBERS = term("owl:members"), term("owl:distinctMembers")
NAMED_INDIVIDUAL, OBJECT_PROPERTY = term("owl:NamedIndividual"), term("owl:ObjectProperty")
DATATYPE_PROPERTY, ANNOTATION_PROPERTY = term("owl:DatatypeProperty"), term("owl:AnnotationProperty")
NEGATIVE_PROPERTY_ASSERTION = term("owl:NegativePropertyAssertion")
SOURCE_INDIVIDUAL, ASSERTION_PROPERTY = term("owl:sourceIndividual"), term("owl:assertionProperty")
TARGET_INDIVIDUAL, TARGET_VALUE = term("owl:targetIndividual"), term("owl:targetValue")
