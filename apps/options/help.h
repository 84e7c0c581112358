// --help: options under headings, in two columns that fit the terminal.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace delray::apps {

// Headings of options, in the order in which options are added.
namespace group {
inline constexpr const char* kInput = "Input";
inline constexpr const char* kOutput = "Output";
inline constexpr const char* kPicture = "Picture";
inline constexpr const char* kCamera = "Camera and animation";
inline constexpr const char* kParallel = "Parallel run";
inline constexpr const char* kSharing = "Parallel run: which rank does what";
inline constexpr const char* kRasterizer = "Rasterizer (--engine raster)";
inline constexpr const char* kRaytracer = "Ray tracer (--engine raytrace)";
inline constexpr const char* kGeneral = "General";  // always the last
}  // namespace group

// Formats help pages, for CLI::App::formatter: description, usage, options by group, subcommands,
// examples. To an option's description it adds the values that are legal, where that does not name
// them.
class HelpFormatter final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* command, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace delray::apps
