// Writes a table as HTML; the page's script sorts it.
#include "apps/report/table.h"

#include <fmt/format.h>

namespace delray::apps::report {

Html table(const Table& table) {
  Html head, body;
  for (const Column& column : table.columns) {
    head += fmt::format(
        "<th class=\"{}\" tabindex=\"0\">{}{}</th>", column.number ? "number" : "",
        escaped(column.name),
        column.labelled ? fmt::format("<span class=\"source\">{}</span>", name_of(column.source))
                        : "");
  }
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    body += static_cast<int>(k) == table.emphasised ? "<tr class=\"emphasised\">" : "<tr>";
    for (std::size_t i = 0; i < table.rows[k].size(); ++i) {
      body += fmt::format("<td class=\"{}\">{}</td>", table.columns[i].number ? "number" : "",
                          escaped(table.rows[k][i]));
    }
    body += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"table\"><table class=\"sortable\"><thead><tr>{}</tr></thead><tbody>\n{}"
      "</tbody></table></div>\n",
      head, body);
}

}  // namespace delray::apps::report
