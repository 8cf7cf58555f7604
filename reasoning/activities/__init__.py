"""Activities: steps in time as relation graphs with Allen labels, told or learned, grounded in sequences of fluents."""
