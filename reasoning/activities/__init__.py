"""Activities: steps in time as relation graphs with Allen labels, described or learned; grounded in fluents."""
