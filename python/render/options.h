// Keywords of Python as options of the command line, by the program's own descriptions of them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace delray::python {

// Sets what the command's options set, from arguments such as "--spp=16". Throws
// std::invalid_argument with the text that the program shows.
void parse_options(CLI::App& command, const std::vector<std::string>& arguments);

// Throws std::invalid_argument for options of `refused` among those that were given, saying `why`.
void refuse_options(const CLI::App& command, const std::vector<std::string>& refused,
                    const std::string& why);

}  // namespace delray::python
