// Assembles the page around its tabs, and embeds pictures as base64 and figures as JSON, so that
// the file needs no other.
#include "apps/report/page.h"

#include <fmt/format.h>

#include "apps/report/style.h"
#include "image/io.h"

namespace delray::apps::report {
namespace {

std::string base64(std::span<const std::byte> bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return i + k < bytes.size() ? std::to_integer<unsigned>(bytes[i + k]) : 0U;
    };
    const unsigned word = at(0) << 16 | at(1) << 8 | at(2);
    for (std::size_t k = 0; k < 4; ++k)
      result += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return result;
}

// JSON that cannot end the script element that it stands in.
std::string embedded(const nlohmann::ordered_json& data) {
  std::string text = data.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string png_url(const image::Image8& image) {
  const std::vector<std::byte> png =
      image::encode_png(image.width, image.height, image.colour.span());
  return "data:image/png;base64," + base64(png);
}

Html picture(const image::Image8& image, const std::string& caption) {
  return fmt::format(
      "<figure class=\"picture\"><img alt=\"{0}\" width=\"{1}\" height=\"{2}\" "
      "src=\"{3}\"><figcaption>{0}</figcaption></figure>\n",
      escaped(caption), image.width, image.height, png_url(image));
}

Html paragraph(const std::string& text) { return "<p>" + escaped(text) + "</p>\n"; }
Html heading(const std::string& text) { return "<h3>" + escaped(text) + "</h3>\n"; }

namespace {

Html grid(const char* name, const std::vector<Html>& figures) {
  Html result = fmt::format("<div class=\"{}\">", name);
  for (const Html& figure : figures) result += figure;
  return result + "</div>\n";
}

}  // namespace

Html advice_beside(const Html& advice, const Html& evidence) {
  return "<div>" + advice + "</div><div>" + evidence + "</div>";
}
Html beside(const std::vector<Html>& figures) { return grid("beside", figures); }
Html in_columns(const std::vector<Html>& figures) { return grid("beside columns", figures); }

Html page(const Page& page) {
  Html tabs, panels;
  for (std::size_t i = 0; i < page.tabs.size(); ++i) {
    const char* selected = i == 0 ? "true" : "false";
    tabs += fmt::format(
        "<button type=\"button\" role=\"tab\" id=\"tab{0}\" aria-controls=\"panel{0}\" "
        "aria-selected=\"{1}\">{2}</button>",
        i, selected, escaped(page.tabs[i].name));
    panels += fmt::format(
        "<section role=\"tabpanel\" id=\"panel{0}\" aria-labelledby=\"tab{0}\"{1}>"
        "<h2>{2}</h2>\n{3}</section>\n",
        i, i == 0 ? "" : " class=\"hidden\"", escaped(page.tabs[i].name), page.tabs[i].body);
  }
  Html provenance;
  for (const auto& [name, value] : page.provenance)
    provenance += fmt::format("<dt>{}</dt><dd>{}</dd>", escaped(name), escaped(value));
  Html result = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">";
  result += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">";
  result += "<title>" + escaped(page.title) + "</title>\n<style>" + internal::kStyle + "</style>";
  result += "</head>\n<body>" + std::string(internal::kMarks) + "<header><h1>" +
            escaped(page.title) + "</h1>\n";
  if (!page.machine.empty()) result += "<p class=\"machine\">" + escaped(page.machine) + "</p>\n";
  if (page.unfinished) {
    result +=
        "<p class=\"unfinished\">This report was interrupted: it shows what had been finished.</p>";
  }
  result += "<div class=\"answer\">" + page.answer + "</div></header>\n";
  result += "<nav role=\"tablist\">" + tabs;
  result += "<button type=\"button\" id=\"csv\">Save CSV</button></nav>\n<main>" + panels;
  result += "</main>\n<footer><h2>To run it again</h2><dl>" + provenance + "</dl></footer>\n";
  result += "<div id=\"tip\" role=\"status\"></div>\n";
  result += "<script type=\"application/json\" id=\"data\">" + embedded(page.data) + "</script>\n";
  result += fmt::format("<script>{}</script>\n</body></html>\n", internal::kScript);
  return result;
}

}  // namespace delray::apps::report
