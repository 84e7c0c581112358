// Charts, tables and pages, looked at as text.
#include "apps/report/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "apps/report/axis.h"
#include "apps/report/bar_chart.h"
#include "apps/report/chart.h"
#include "apps/report/matrix.h"
#include "apps/report/overlay.h"
#include "apps/report/plot.h"
#include "apps/report/stacked_bars.h"
#include "apps/report/table.h"
#include "apps/report/timeline.h"

namespace delray::apps::report {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t result = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++result;
  return result;
}

bool has_bad_number(std::string html) {
  for (std::size_t at; (at = html.find("dominant")) != std::string::npos;) html.erase(at, 8);
  return html.find("nan") != std::string::npos || html.find("inf") != std::string::npos;
}

TEST(ReportHtml, EscapesWhatCouldEndTextOrAttributes) {
  EXPECT_EQ(escaped("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
}

TEST(ReportHtml, ShortensNumbers) {
  EXPECT_EQ(short_number(0.053124), "0.05312");
  EXPECT_EQ(short_number(2048), "2048");
  EXPECT_EQ(short_number(20480), "20.48 k");
  EXPECT_EQ(short_number(-1234567), "-1.235 M");
  EXPECT_EQ(short_number(3e9), "3 G");
  EXPECT_EQ(short_number(std::numeric_limits<double>::infinity()), "-");
}

TEST(ReportAxis, LinearTicksAreRoundAndInside) {
  for (const double most : {1e-9, 0.3, 7.0, 99.0, 12345.0, 1e12}) {
    const std::vector<double> values = {most / 3, most};
    const Axis axis(values, Scale::linear);
    EXPECT_EQ(axis.position(0), 0);
    EXPECT_EQ(axis.position(most), 1);
    const std::vector<Tick> ticks = axis.ticks();
    EXPECT_GE(ticks.size(), 3U) << most;
    EXPECT_LE(ticks.size(), 11U) << most;
    for (const Tick& tick : ticks) {
      EXPECT_GE(axis.position(tick.value), -1e-9);
      EXPECT_LE(axis.position(tick.value), 1 + 1e-9);
    }
  }
}

TEST(ReportAxis, LogarithmicTicksCoverWhatThereIs) {
  const std::vector<double> decades = {0.02, 3, 4000, -1, 0, std::nan("")};
  const Axis axis(decades, Scale::logarithmic);
  EXPECT_NEAR(axis.position(0.02), 0, 1e-12);
  EXPECT_NEAR(axis.position(4000), 1, 1e-12);
  EXPECT_NEAR(axis.position(std::sqrt(0.02 * 4000)), 0.5, 1e-12);
  for (const std::vector<double>& values :
       {decades, {5.0}, {}, {1.1, 1.2}, {1e-8, 1e+12}, {3.0, 300.0}, {1.2, 3}}) {
    const std::vector<Tick> ticks = Axis(values, Scale::logarithmic).ticks();
    EXPECT_GE(ticks.size(), 2U);
    EXPECT_LE(ticks.size(), 12U);
  }
  const std::vector<double> narrow = {1.01, 3.5};
  EXPECT_GE(Axis(narrow, Scale::logarithmic).ticks().size(), 4U);
}

TEST(ReportCharts, DrawEveryPointThatCanBeShown) {
  LineChart chart;
  chart.title = "a < b";
  chart.x_scale = chart.y_scale = Scale::logarithmic;
  chart.series = {{"one", Source::measured, {{1, 2}, {2, 3, 2.5, 4}, {4, std::nan("")}, {8, -1}}},
                  {"two", Source::predicted, {{1, 5}}},
                  {"none", Source::counted, {}}};
  const Html html = line_chart(chart);
  EXPECT_EQ(count(html, "</title></use>"), 3U);
  EXPECT_EQ(count(html, "<button"), 3U);
  EXPECT_NE(html.find("a &lt; b"), std::string::npos);
  EXPECT_NE(html.find("3 (measured, 2.5 to 4)"), std::string::npos);
  EXPECT_FALSE(has_bad_number(html));
}

TEST(ReportCharts, AreWholeWithoutData) {
  for (const Html& html :
       {line_chart({}), bar_chart({}), timeline({}), matrix({}), stacked_bars({})}) {
    EXPECT_FALSE(has_bad_number(html)) << html;
    EXPECT_EQ(count(html, "<svg"), count(html, "</svg>"));
    EXPECT_EQ(count(html, "<figure"), count(html, "</figure>"));
  }
}

TEST(ReportCharts, BarsMatricesAndTimelinesTellTheirNumbers) {
  const Html bars =
      bar_chart({"t", "bytes", Source::counted, {{"r0", 3, "x", true}, {"r1", 4, ""}}, 3.5});
  EXPECT_EQ(count(bars, "<rect class=\"bar"), 2U);
  EXPECT_NE(bars.find("r0: 3 bytes (counted); x"), std::string::npos);
  EXPECT_LT(bars.find("class=\"mark\""), bars.find("tick value"));  // numbers lie above the mark
  const Html cells = matrix({"m", "from", "to", "bytes", Source::counted, 2, 2, {0, 7, 0, 9}});
  EXPECT_EQ(count(cells, "class=\"cell\""), 2U + 3U);  // and in the legend
  EXPECT_NE(cells.find("2.25 bytes"), std::string::npos);
  EXPECT_NE(cells.find("from 1, to 1: 9 bytes (counted)"), std::string::npos);
  const Html lanes = timeline(
      {"t", Source::measured, {"work", "wait"}, {{"rank 0", {{0, 1, 1.5, ""}, {1, 1.5, 3, "q"}}}}});
  EXPECT_NE(lanes.find("rank 0: wait 1500 ms (measured); q"), std::string::npos);
  EXPECT_EQ(lanes.find("idle"), std::string::npos);
  Timeline waits{"t", Source::counted, {"work", "wait"}, {{"rank 0", {{1, 1.5, 3, ""}}}}, 1};
  EXPECT_EQ(count(timeline(waits), "span idle"), 2U);  // and in the legend
}

TEST(ReportCharts, SayWhereThereIsNothingToSee) {
  LineChart chart;
  chart.y_scale = Scale::logarithmic;
  chart.series = {{"none", Source::predicted, {{1, 0}, {2, 0}}}};
  EXPECT_NE(line_chart(chart).find("nothing but zeros"), std::string::npos);
  chart.series[0].points[1].y = 3;
  const Html html = line_chart(chart);
  EXPECT_EQ(html.find("nothing but zeros"), std::string::npos);
  EXPECT_EQ(count(html, "c0 d0 predicted\""), 2U);  // the line, and its key looks like it
  const Html cells = matrix({"m", "from", "to", "bytes", Source::counted, 1, 2, {0, 0}}, 9);
  EXPECT_NE(cells.find("nothing"), std::string::npos);
}

TEST(ReportCharts, SeriesKeepTheirLookWhateverTheirPlace) {
  LineChart chart;
  chart.series = {{"one", Source::measured, {{1, 2}}},
                  {"two", Source::measured, {{1, 3}}, {4, 2, 1, "group"}}};
  const Html html = line_chart(chart);
  EXPECT_EQ(count(html, "class=\"series c0 d0\""), 1U);
  EXPECT_EQ(count(html, "class=\"series c4 d1\""), 1U);
  EXPECT_EQ(count(html, "class=\"key c4 d1\""), 1U);
  EXPECT_EQ(count(html, "href=\"#m2\""), 2U);  // at its point and in the legend
}

// Two groups of three; the last is best most often although the first has the least value of all.
LineChart crowded_chart() {
  LineChart chart;
  for (const char* name : {"a", "b", "c"})
    chart.series.push_back({name, Source::measured, {}, {0, 0, 0, "first"}});
  for (const char* name : {"d", "e", "f"})
    chart.series.push_back({name, Source::measured, {}, {1, 0, 0, "second"}});
  chart.series[0].points = {{1, 0}, {2, 9}, {3, 9}};
  chart.series[1].points = {{1, 5}, {2, 5}, {3, 9}};
  chart.series[2].points = {{1, 6}, {2, 4}, {3, 4}};
  for (std::size_t i = 3; i < 6; ++i) chart.series[i].points = {{1, 10.0 + static_cast<double>(i)}};
  return chart;
}

TEST(ReportCharts, OfManyLinesDrawTheBestOfEachGroupInColour) {
  LineChart chart = crowded_chart();
  EXPECT_EQ(strong_series(chart), (std::vector<bool>{false, false, true, true, false, false}));
  const Html html = line_chart(chart);
  EXPECT_EQ(count(html, "class=\"series c0 d0 weak\""), 2U);
  EXPECT_EQ(count(html, "class=\"series c0 d0\""), 1U);
  EXPECT_EQ(count(html, "class=\"name\""), 6U);
  EXPECT_EQ(count(html, "class=\"group\""), 2U);
  chart.more_is_better = true;
  EXPECT_EQ(strong_series(chart), (std::vector<bool>{true, false, false, false, false, true}));
  chart.series.resize(kMostStrong);
  EXPECT_EQ(strong_series(chart), std::vector<bool>(kMostStrong, true));
}

TEST(ReportCharts, NamesOfLinesThatEndTogetherDoNotTouch) {
  LineChart chart;
  chart.series = {{"one", Source::measured, {{1, 5}, {2, 5}}},
                  {"two", Source::measured, {{2, 5}}},
                  {"three", Source::measured, {{2, 5.1}, {4, 5}}},
                  {"four", Source::measured, {{4, 0}}}};
  const Html html = line_chart(chart);
  const auto position = [&](const std::string& name) {
    const std::size_t at = html.rfind(" y=\"", html.find(">" + name + "</text>"));
    return std::stod(html.substr(at + 4));
  };
  EXPECT_GE(std::abs(position("one") - position("two")), 15);
  EXPECT_EQ(position("four"), 280);  // at the bottom, where its line ends
}

TEST(ReportCharts, MoveNamesApartWithinTheChart) {
  std::vector<double> names = {10, 12, 11, 95, 99};
  internal::move_apart(names, 10, 0, 100);
  EXPECT_EQ(names, (std::vector<double>{10, 30, 20, 90, 100}));
  std::vector<double> many(21, 50.0);
  internal::move_apart(many, 10, 0, 100);
  for (std::size_t i = 0; i < many.size(); ++i)
    EXPECT_NEAR(many[i], 5.0 * static_cast<double>(i), 1e-9);
  std::vector<double> none;
  internal::move_apart(none, 10, 0, 100);
  EXPECT_TRUE(none.empty());
}

TEST(ReportCharts, LabelsOfTicksDoNotTouch) {
  const std::vector<double> values = {2, 3, 4, 8, 16, 64, 256, 1024, 4096};
  const Axis axis(values, Scale::logarithmic);
  const Html html = internal::ticks_across(
      Axis::ticks_at(values), [&](double value) { return axis.position(value); }, 280, "ranks");
  EXPECT_EQ(count(html, "class=\"grid\""), values.size());
  double end = -100;  // of the label before, in a plot of 190 pixels
  std::size_t always = 0;
  for (std::size_t at = html.find("class=\"tick\""); at != std::string::npos;
       at = html.find("class=\"tick\"", at + 1)) {
    const double centre = std::stod(html.substr(html.find("x=\"", at) + 3)) * 1.9;
    const std::size_t text = html.find('>', at) + 1;
    const double half = internal::text_width(html.substr(text, html.find('<', text) - text)) / 2;
    EXPECT_GT(centre - half, end);
    end = centre + half;
    ++always;
  }
  EXPECT_GE(always, 4U);
  EXPECT_LE(always + count(html, "tick spare"), values.size());
  EXPECT_GE(count(html, "tick spare"), 1U);
}

TEST(ReportCharts, StackedBarsShowPartsWhereTheirSumBegins) {
  StackedBars chart{"t", "ms", Source::measured, false, {"a", "b"}, {{"x", {1, 3}}, {"y", {0, 8}}}};
  const Html amounts = stacked_bars(chart);
  EXPECT_EQ(count(amounts, "<rect"), 3U);  // what is 0 is left out
  EXPECT_NE(amounts.find("x: b 3 ms, 75.0 % (measured)"), std::string::npos);
  EXPECT_NE(amounts.find("y: b 8 ms, 100.0 % (measured)"), std::string::npos);
  chart.shares = true;
  const auto widths = [](const Html& html) {
    double sum = 0;
    for (std::size_t at = html.find("<rect"); at != std::string::npos;
         at = html.find("<rect", at + 1))
      sum += std::stod(html.substr(html.find("width=\"", at) + 7));
    return sum;
  };
  // All bars are as long as the longest one was.
  EXPECT_NEAR(widths(stacked_bars(chart)), 2 * widths(amounts) * 8 / 12, 0.1);
  chart.bars = {{"none", {0, 0}}};
  EXPECT_FALSE(has_bad_number(stacked_bars(chart)));
}

TEST(ReportOverlay, DrawsAreasAndTheBordersBetweenGroups) {
  Overlay two{"two & more", Source::counted, 8, 4, {}};
  two.areas = {
      {{0, 0, 4, 2}, 0, 1.5, "a<b"}, {{0, 2, 4, 4}, 0, 1, "c"}, {{4, 0, 8, 4}, 1, 0.5, "d"}};
  const Html html = overlay(two, "below");
  EXPECT_EQ(count(html, "class=\"above\""), 1U);
  EXPECT_EQ(count(html, "class=\"below\""), 2U);
  EXPECT_NE(html.find("<title>a&lt;b (counted)</title>"), std::string::npos);
  EXPECT_NE(html.find("two &amp; more"), std::string::npos);
  EXPECT_NE(html.find("href=\"#below\""), std::string::npos);
  // One line from top to bottom, none within the first group.
  EXPECT_NE(html.find("d=\"M4 0V4\""), std::string::npos) << html;
  two.shading = Shading::amount;
  EXPECT_EQ(count(overlay(two, "below"), "class=\"amount\" fill-opacity=\"0.900\""), 2U);
  two.shading = Shading::group;
  EXPECT_EQ(count(overlay(two, "below"), "fill=\"hsl(138 "), 1U);
  EXPECT_FALSE(has_bad_number(html));
  EXPECT_FALSE(has_bad_number(overlay({}, "none")));
  EXPECT_NE(backdrop(image::Image8(3, 2), "below").find("<symbol id=\"below\""), std::string::npos);
}

TEST(ReportPage, HoldsAllAndNothingEndsItsScriptsEarly) {
  Page page;
  page.title = "A & B";
  page.answer = paragraph("use it");
  page.unfinished = true;
  Table rows;
  rows.columns = {{"name", false}, {"n"}};
  rows.rows = {{"</script>", "1"}};
  page.tabs = {{"First", table(rows)}, {"Second", picture(image::Image8(3, 2), "small")}};
  page.data = {{"schema", "delray.test/1"}, {"rows", {{{"text", "</script><b>"}}}}};
  page.provenance = {{"command", "delray <x>"}};
  page.machine = "processor; compiler 1.2";
  const Html html = report::page(page);
  EXPECT_EQ(count(html, "<script"), 2U);
  EXPECT_EQ(count(html, "</script>"), 2U);
  EXPECT_EQ(count(html, "<section"), 2U);
  EXPECT_NE(html.find("<p class=\"machine\">processor; compiler 1.2</p>"), std::string::npos);
  EXPECT_NE(html.find("was interrupted"), std::string::npos);
  EXPECT_NE(html.find("delray &lt;x&gt;"), std::string::npos);
  EXPECT_NE(html.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
  // Nothing from elsewhere.
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find("src=\"/"), std::string::npos);
}

}  // namespace
}  // namespace delray::apps::report
