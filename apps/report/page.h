// A report as one file of HTML that needs nothing else: styles, scripts, charts, pictures and data
// are in it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/report/html.h"
#include "image/image.h"

namespace delray::apps::report {

struct Tab {
  std::string name;
  Html body;
};

struct Page {
  std::string title;
  std::string machine;          // what measured and compiled; empty: not told
  Html answer;                  // the first screen: what to use here, and why
  bool unfinished = false;      // it was interrupted; the page says so
  std::vector<Tab> tabs;        // the evidence
  nlohmann::ordered_json data;  // its member "rows" is what is saved as CSV
  std::vector<std::pair<std::string, std::string>> provenance;  // what it takes to run it again
};

Html page(const Page& page);

// The picture itself as the address of an image.
std::string png_url(const image::Image8& image);
// A picture with a caption, embedded.
Html picture(const image::Image8& image, const std::string& caption);

// Paragraphs and headings.
Html paragraph(const std::string& text);
Html heading(const std::string& text);
// The first screen: what to do, and beside it, where there is room, what tells so.
Html advice_beside(const Html& advice, const Html& evidence);
// Figures side by side, as many as there is room for: small ones, or charts.
Html beside(const std::vector<Html>& figures);
Html in_columns(const std::vector<Html>& figures);

}  // namespace delray::apps::report
