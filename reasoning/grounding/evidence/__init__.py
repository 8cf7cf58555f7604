"""Evidence for matches: facts, labels, sizes and colours as log-likelihood ratios."""
