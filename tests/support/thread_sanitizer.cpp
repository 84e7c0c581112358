// What ThreadSanitizer is told about libraries that it cannot see into. oneTBB hands memory from
// one thread to another by means that are not instrumented and clears it with memset; only such
// calls made by the library itself are left out, our code in its tasks stays checked.
extern "C" const char* __tsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "called_from_lib:libtbb.so\n"
         "deadlock:openmpi\n";  // it takes two of its locks in either order
}
