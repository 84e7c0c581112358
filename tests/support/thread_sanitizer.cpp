// What ThreadSanitizer is told about libraries that it cannot see into. Nothing of oneTBB and
// Embree: where the tree is built with it, loops run on plain threads and Embree builds on the
// thread that asks for it (parallel/arena.cpp), so that no race of ours is left out.
extern "C" const char* __tsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "deadlock:openmpi\n";                          // it takes two of its locks in either order
}
