// Puts the page together. NONCE is replaced by the server, once for each answer.
#include "apps/view/page.h"

#include "apps/report/style.h"

namespace delray::apps::view {

std::string page() {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>delray view</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>";
  text += report::internal::kStyle;
  text += internal::kStyle;
  text += "</style></head>\n";
  text += internal::kBody;
  text += "<script nonce=\"NONCE\">'use strict';\n(() => {\n";
  for (const char* const part :
       {internal::kCamera, internal::kConnection, internal::kPanel, internal::kControls}) {
    text += part;
  }
  return text + "})();\n</script>\n</html>\n";
}

}  // namespace delray::apps::view
