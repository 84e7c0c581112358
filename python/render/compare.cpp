// Comparisons, as `delray compare` makes them; their JSON becomes tables in Python.
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/compare/comparison.h"
#include "python/render/log.h"
#include "python/render/module.h"
#include "python/render/options.h"
#include "python/work.h"

namespace py = pybind11;

namespace delray::python {
namespace {

// The JSON of "delray compare ARGUMENTS".
std::string compare(const std::vector<std::string>& arguments) {
  apps::Session session;
  session.quiet = true;
  apps::Json found;
  session.take_comparison = [&found](apps::Found&& made) { found = std::move(made.statistics); };
  CLI::App program("", "delray");
  program.require_subcommand(1);
  apps::add_compare(program, session);
  std::vector<std::string> all = {"compare"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  parse_options(program, all);
  // Several take turns in one process: the number of threads is their own.
  run({thread_count({}), true, &session.progress}, [&](parallel::Progress&) { session.run(); });
  show_warnings();
  return found.dump();
}

}  // namespace

void add_compare(py::module_& module) { module.def("compare", &compare, py::arg("arguments")); }

}  // namespace delray::python
