#include "measure/table.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace coppice {

namespace {

// Where a table takes a value for something else.
template <class... Functions>
struct Cases : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Cases(Functions...) -> Cases<Functions...>;  // clang 14 does not find it by itself

const Cell& cell_at(const Row& row, std::size_t column) {
  static const Cell none;
  return column < row.cells.size() ? row.cells[column] : none;
}

// As text and Markdown show it, without padding.
std::string shown(const Column& column, const Cell& cell) {
  if (cell.shown) return *cell.shown;
  return std::visit(
      Cases{[](std::monostate) { return std::string(); }, [](Cell::Unknown) { return std::string("-"); },
            [](bool value) { return std::string(value ? "yes" : "no"); },
            [&](std::uint64_t value) { return std::to_string(value) + column.unit; },
            [&](double value) {
              const char* const pattern = column.style == 'g' ? "%.*g" : "%.*f";
              char text[400];
              std::snprintf(text, sizeof text, pattern, column.precision, value);
              return text + column.unit;
            },
            [](const std::string& value) { return value; }},
      cell.value);
}

std::string padded(const std::string& text, int width) {
  const auto size = static_cast<std::size_t>(std::abs(width));
  const std::string blanks(size > text.size() ? size - text.size() : 0, ' ');
  return width < 0 ? text + blanks : blanks + text;
}

// A field between quotes.
std::string quoted(std::string text) {
  for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
  return '"' + text + '"';
}

std::string csv_field(const Column& column, const Cell& cell) {
  return std::visit(
      Cases{[](std::monostate) { return std::string(); }, [](Cell::Unknown) { return std::string(); },
            [](bool value) { return std::string(value ? "1" : "0"); },
            [](std::uint64_t value) { return std::to_string(value); },
            [](double value) { return format("%.9g", value); },
            [&](const std::string& value) { return column.quoted ? quoted(value) : value; }},
      cell.value);
}

void add_to_json(Json& json, const Column& column, const Cell& cell) {
  std::visit(Cases{[](std::monostate) {}, [&](Cell::Unknown) { json[column.key] = nullptr; },
                   [&](const auto& value) { json[column.key] = value; }},
             cell.value);
}

}  // namespace

std::string format(const char* pattern, ...) {
  va_list arguments, again;
  va_start(arguments, pattern);
  va_copy(again, arguments);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, pattern, arguments)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  va_end(arguments);
  return text;
}

void print(const std::string& text) { std::fputs(text.c_str(), stdout); }

std::size_t Table::column(const Column& column) {
  const auto found = std::ranges::find(columns_, column.key, &Column::key);
  const auto index = static_cast<std::size_t>(found - columns_.begin());
  if (found == columns_.end()) columns_.push_back(column);
  return index;
}

void Table::set_all(const Column& wanted, const Cell& cell) {
  const std::size_t index = column(wanted);
  for (Row& row : rows_) {
    if (row.cells.size() <= index) row.cells.resize(index + 1);
    row.cells[index] = cell;
  }
}

std::string Table::text_header() const {
  std::string line;
  for (const Column& column : columns_) {
    if (column.places & IN_TEXT)
      line += std::string(static_cast<std::size_t>(column.gap), ' ') + padded(column.heading, column.width);
  }
  return line + "\n";
}

std::string Table::text(const Row& row) const {
  std::string lines;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    if (!(column.places & IN_TEXT)) continue;
    lines += std::string(static_cast<std::size_t>(column.gap), ' ') +
             padded(shown(column, cell_at(row, i)), column.width);
  }
  lines += row.remark + "\n";
  for (const std::string& line : row.below) lines += line + "\n";
  return lines;
}

std::string Table::text() const {
  std::string lines = text_header();
  for (const Row& row : rows_) lines += text(row);
  return lines;
}

std::string Table::csv() const {
  std::string lines;
  for (std::size_t line = 0; line <= rows_.size(); ++line) {
    if (line > 0) lines += '\n';
    bool first = true;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!(columns_[i].places & IN_CSV)) continue;
      if (!std::exchange(first, false)) lines += ',';
      lines += line == 0 ? columns_[i].key : csv_field(columns_[i], cell_at(rows_[line - 1], i));
    }
  }
  return lines;
}

Json Table::json(const Row& row) const {
  Json json = Json::object();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].places & IN_JSON) add_to_json(json, columns_[i], cell_at(row, i));
  }
  return json;
}

Json Table::json() const {
  Json rows = Json::array();
  for (const Row& row : rows_) rows.push_back(json(row));
  return rows;
}

std::string Table::markdown() const {
  std::string head, rule;
  for (const Column& column : columns_) {
    if (!(column.places & IN_MARKDOWN)) continue;
    head += "| " + column.heading + " ";
    rule += "|---";
  }
  std::string lines = head + "|\n" + rule + "|\n";
  for (const Row& row : rows_) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!(columns_[i].places & IN_MARKDOWN)) continue;
      const std::string cell = shown(columns_[i], cell_at(row, i));
      lines += cell.empty() ? "| " : "| " + cell + " ";
    }
    lines += "|\n";
  }
  return lines;
}

}  // namespace coppice
