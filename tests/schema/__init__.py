"""Documents for schema_test.py."""
