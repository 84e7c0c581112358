// Holds the precompiled header of all libraries: see DelrayTargets.cmake.
