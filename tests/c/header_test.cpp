// C++ reads the header, too.
#include <delray.h>

int main() { return delrayApiVersion() == DELRAY_API_VERSION ? 0 : 1; }
