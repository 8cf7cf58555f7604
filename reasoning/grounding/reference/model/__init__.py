"""The log-linear model of reference: scores of objects, frames of reference, and the fit of the weights."""
