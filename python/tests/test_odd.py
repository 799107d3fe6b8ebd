"""Troubles that users of other tools have reported, rebuilt with geometry of our own: one test a trouble, named
for what is odd; its docstring says what is right. Those of files and of the C++ library stand in tests/odd/."""
