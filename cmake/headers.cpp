// Headers that others reuse precompiled need a source to be compiled with.
