"""Webhooks (Standard Webhooks 1.0): owners are told of the states of their jobs at addresses of their own."""
