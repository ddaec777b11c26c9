"""Which structure: evidence, prediction of left-out records, and what matters."""
