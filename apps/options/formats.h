// The formats that are read, as their readers' tables have them.
#pragma once

#include <string>

namespace delray::apps {

// For --list.
void list_formats();

// For --help: "scene (OBJ, PLY, ...), points (...), mesh (...) or picture (...)".
std::string format_names();

}  // namespace delray::apps
