"""Stand-ins for packages that are not maintained any more."""
