"""Pictures from gudgeon's results: figures, comparisons, reports."""
