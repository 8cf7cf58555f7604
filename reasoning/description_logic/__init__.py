"""Description logic: consistency, classification, entailment and justifications of OWL ontologies."""
