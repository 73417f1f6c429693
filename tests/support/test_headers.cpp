// Nothing: its target has the precompiled header that the tests share.
