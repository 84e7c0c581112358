// Names of compositing schemes as users write them: some take radices, "radix-k:4,2".
#include "apps/options/scheme_option.h"

#include "apps/options/list.h"
#include "composite/scheme.h"

namespace delray::apps {

void choose_scheme(CLI::App& command) {
  choose_from(command, "--compose", names_in(composite::schemes()),
              {"radix-k:4,2",
               [](const std::string& name) { return composite::find_scheme(name) != nullptr; }});
}

}  // namespace delray::apps
