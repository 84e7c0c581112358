// --compose: the compositing scheme, of commands that have one.
#pragma once

namespace CLI {
class App;
}

namespace delray::apps {

// Lets --compose, which has been added, be a scheme of the table, or one of them with radices.
void choose_scheme(CLI::App& command);

}  // namespace delray::apps
