// The target of shared precompiled headers needs a source.
