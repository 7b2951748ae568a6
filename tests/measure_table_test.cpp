// One table, written in four ways.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "measure/table.h"

namespace coppice {
namespace {

constexpr unsigned everywhere = IN_TEXT | IN_CSV | IN_JSON | IN_MARKDOWN;

Table table() {
  Table table({{.key = "name", .heading = "kernel", .width = -8, .places = everywhere, .gap = 2},
               {.key = "ms", .heading = "ms", .width = 7, .precision = 2, .places = everywhere},
               {.heading = "share", .width = 7, .precision = 1, .places = IN_TEXT, .unit = "%"},
               {.key = "count", .heading = "n", .width = 4, .places = everywhere},
               {.key = "date", .places = IN_CSV, .quoted = false}});
  table.add({{"sort", 1.25, 62.5, 3u, "2026-01-02"}, "  slow"});
  table.add({{"a \"b\"", std::optional<double>(), {}, Cell(12u).shown_as("12 on")}, "", {"  below"}});
  return table;
}

TEST(Table, TextStandsInColumns) {
  EXPECT_EQ(table().text(),
            "  kernel        ms   share    n\n"
            "  sort        1.25   62.5%    3  slow\n"
            "  a \"b\"          -         12 on\n"
            "  below\n");
}

TEST(Table, CsvQuotesTextsAndLeavesOutWhatIsUnknown) {
  EXPECT_EQ(table().csv(), "name,ms,count,date\n\"sort\",1.25,3,2026-01-02\n\"a \"\"b\"\"\",,12,");
}

TEST(Table, JsonHasNullForWhatIsUnknownAndNothingForWhatIsNot) {
  EXPECT_EQ(table().json().dump(),
            R"([{"name":"sort","ms":1.25,"count":3},{"name":"a \"b\"","ms":null,"count":12}])");
  Table partial({{.key = "a", .places = IN_JSON}, {.key = "b", .places = IN_JSON}});
  partial.add({{Cell(), true}});
  partial.add({{1u}});
  EXPECT_EQ(partial.json().dump(), R"([{"b":true},{"a":1}])");
}

TEST(Table, MarkdownShowsWhatTextShows) {
  EXPECT_EQ(table().markdown(),
            "| kernel | ms | n |\n|---|---|---|\n| sort | 1.25 | 3 |\n| a \"b\" | - | 12 on |\n");
}

// Rows may bring columns along; those before have no value in them.
TEST(Table, ColumnsMayComeLater) {
  Table grown({{.key = "a", .places = IN_CSV | IN_JSON}});
  grown.add({{1u}});
  const std::size_t b = grown.column({.key = "b", .places = IN_CSV | IN_JSON});
  EXPECT_EQ(b, 1u);
  EXPECT_EQ(grown.column({.key = "a", .places = IN_CSV | IN_JSON}), 0u);
  grown.add({{2u, 0.5}});
  grown.set_all({.key = "c", .places = IN_CSV}, true);
  EXPECT_EQ(grown.csv(), "a,b,c\n1,,1\n2,0.5,1");
  EXPECT_EQ(grown.json().dump(), R"([{"a":1},{"a":2,"b":0.5}])");
}

}  // namespace
}  // namespace coppice
