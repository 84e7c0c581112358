// What ThreadSanitizer is told about libraries that it cannot see into. oneTBB and Embree, which
// builds in oneTBB's tasks, hand memory from one thread to another by means that are not
// instrumented, clear it with memset and free it elsewhere; only such calls made by the libraries
// themselves are left out, our code in their tasks and in Embree's filters stays checked.
extern "C" const char* __tsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "called_from_lib:libtbb.so\n"
         "called_from_lib:libembree3.so\n"
         "deadlock:openmpi\n";  // it takes two of its locks in either order
}
