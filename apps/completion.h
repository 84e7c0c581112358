// Scripts by which a shell completes the words of a command line.
#pragma once

#include <span>
#include <string>

#include "apps/options/command_text.h"

namespace delray::apps {

// A shell that command lines are completed for.
struct Shell {
  const char* name;
  const char* description;  // how to use the script
  std::string (*completion)(const CommandText& program);
};

std::span<const Shell> shells();

}  // namespace delray::apps
