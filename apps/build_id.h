// Which build of the program this is.
#pragma once

#include <string>

namespace delray::apps {

// The build id that the linker has put into the program and into its loaded libraries, a hash of
// all that was linked, in hexadecimal digits; "unknown" where it was told not to. Other builds have
// another one, be it of the same source by another compiler.
std::string build_id();

}  // namespace delray::apps
