// What a page shows and how: options of `delray render`, by the program's own tables.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/render/options/render_options.h"
#include "apps/statistics.h"

namespace delray::apps::view {

// Options that were given, in this order: "--engine", "raytrace". The value of a flag is "true".
using Options = std::vector<std::pair<std::string, std::string>>;

// Sets an option, or takes it away where the value is empty.
void set_option(Options& options, const std::string& name, const std::string& value);
// The value of an option; empty where it was not given.
std::string option_of(const Options& options, const std::string& name);

// An option that a page may set.
struct PanelOption {
  const char* name;
  enum class Scope {
    page,   // of one page alone
    scene,  // of what is loaded, which all pages show
    ranks,  // of the ranks and threads that render for all pages
  } scope = Scope::page;
};
// The table of those, in the order of the page. What they are, the table of options says.
std::vector<PanelOption> panel_options();
// Null where a page may not set it.
const PanelOption* find_panel_option(const std::string& name);

// The words that name the scene, and options that no page sets.
using Input = std::vector<std::string>;

// Requests for pictures: of a scene at rest, and of one that moves, by the rasterizer with a sample
// per pixel. Options that change nothing beside the others are left out of either.
struct Look {
  RenderRequest still, moving;
  Options still_options, moving_options;  // those that are in force
};
// Throws UsageError for options that cannot be, or cannot be together.
Look make_look(const Input& input, const Options& options);
// One of the two: of `options` those that are in force are left.
RenderRequest make_request(const Input& input, Options& options);
void set_size(int width, int height, RenderRequest& request);

// The panel for a page: groups of options with what they are, what they may be, and what they are
// now: [{"name", "options": [{"name", "help", "values", "range", "flag", "value", "scope",
// "default", "idle"}]}].
Json panel_of(const Input& input, const Options& options);

// A camera as command lines have it: of --camera, and of --clip, where that is above 0.
struct CameraWords {
  std::string camera;
  float clip = 0;
};
// The command line of `delray render` for the picture, as a shell reads it. Where there is a
// camera, it stands for those that `input` names.
std::string command_for(const Input& input, const Look& look, const CameraWords& camera);

}  // namespace delray::apps::view
