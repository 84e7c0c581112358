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
// Figures side by side where there is room: small ones, or two charts.
Html beside(const std::vector<Html>& figures);
Html in_pairs(const std::vector<Html>& figures);

}  // namespace delray::apps::report
