"""Numbers with units: read from what a caller gives, and shown as attributes, texts, tables and
JSON.
"""
