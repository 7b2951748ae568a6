// Tables and plots of a comparison stay whole whatever the scenes are called and the rows say.
#include "measure/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "measure/comparison_text.h"

namespace coppice {
namespace {

TEST(ComparisonText, IsOneLineOfUtf8) {
  EXPECT_EQ(one_line("a\nb\r\tc\x01\x7f"), "a b  c  ");
  EXPECT_EQ(one_line("gr\xC3\xBC\xC3\x9F \xF0\x9F\x8C\xB3"), "gr\xC3\xBC\xC3\x9F \xF0\x9F\x8C\xB3");
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(one_line("\xFF"), bad);
  EXPECT_EQ(one_line("a\xC3"), "a" + bad);               // cut
  EXPECT_EQ(one_line("\xC0\xAF"), bad + bad);            // overlong
  EXPECT_EQ(one_line("\xED\xA0\x80"), bad + bad + bad);  // a surrogate
  EXPECT_EQ(one_line("\xEF\xBF\xBF"), bad + bad + bad);  // U+FFFF, which XML forbids
  EXPECT_EQ(one_line("\xF4\x90\x80\x80x"), bad + bad + bad + bad + "x");
}

TEST(ComparisonText, HoldsNoMarkup) {
  EXPECT_EQ(markdown_text("a&b<c>|`*_d_\n[x](y)"), "a&amp;b&lt;c&gt;\\|\\`\\*\\_d\\_ \\[x\\](y)");
  EXPECT_EQ(markdown_text("my_scene.obj, Mesa 25.0.7-2~bpo12+1"), "my_scene.obj, Mesa 25.0.7-2~bpo12+1");
  EXPECT_EQ(markdown_text("~~x~~"), "\\~\\~x\\~\\~");
  EXPECT_EQ(xml_text("a&b<c>\"d'e\n`|"), "a&amp;b&lt;c&gt;&quot;d&#39;e `|");
}

SceneComparison odd_scene(const std::string& name, const std::string& reason) {
  SceneComparison scene{name, 3, {}};
  ComparisonRow good;
  good.builder = "ploc";
  good.build_ms = good.frame_ms = 1;
  scene.rows = {good, {}};
  scene.rows[1].builder = "sah";
  scene.rows[1].infeasible = reason;
  return scene;
}

TEST(Comparison, ATableHasItsRowsAndColumnsWhateverTheySay) {
  const std::string reason = "failed: " + std::string(3000, 'x') + " | `a`\nb <i>";
  const std::string table = to_markdown({odd_scene("a|b\n| c |\n", reason)}, "on a <device>\n| x |");
  std::vector<std::string> lines;
  std::string line;
  for (const char c : table) {
    if (c != '\n') {
      line += c;
      continue;
    }
    lines.push_back(std::exchange(line, {}));
  }
  ASSERT_EQ(lines.size(), 8u) << table;  // conditions, blank, heading, blank, header, rule, two rows
  EXPECT_EQ(lines[2], "### a\\|b \\| c \\| , 3 triangles");
  const auto columns = [](const std::string& row) {
    std::ptrdiff_t bars = 0;
    for (std::size_t i = 0; i < row.size(); ++i) bars += row[i] == '|' && (i == 0 || row[i - 1] != '\\');
    return bars;
  };
  for (std::size_t i = 5; i < lines.size(); ++i) EXPECT_EQ(columns(lines[i]), columns(lines[4])) << lines[i];
  EXPECT_NE(lines[7].find(std::string(3000, 'x')), std::string::npos);
  EXPECT_TRUE(lines[7].ends_with("|"));
}

TEST(Comparison, APlotIsXmlWhateverTheSceneIsCalled) {
  const std::string name = "<&'\">" + std::string(2000, 'n');
  const std::string svg = to_svg({odd_scene(name, "no")});
  EXPECT_NE(svg.find("&lt;&amp;&#39;&quot;&gt;" + std::string(2000, 'n')), std::string::npos);
  EXPECT_EQ(svg.find(name), std::string::npos);
  EXPECT_EQ(std::ranges::count(svg, '<'), std::ranges::count(svg, '>'));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

}  // namespace
}  // namespace coppice
