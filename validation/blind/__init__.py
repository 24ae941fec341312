"""Blind predictions of measured crashes: inputs fixed first, measurements read afterwards."""
