#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "measure/json.h"

namespace coppice {

// Where a column stands.
enum ColumnPlace : unsigned { IN_TEXT = 1, IN_CSV = 2, IN_JSON = 4, IN_MARKDOWN = 8 };

struct Column {
  std::string key{};      // in CSV and JSON
  std::string heading{};  // in text and Markdown
  int width = 0;          // in text, unit included; negative: to the left
  int precision = 0;      // of numbers with a fraction
  unsigned places = IN_TEXT | IN_JSON;
  std::string unit{};  // behind each number
  char style = 'f';    // of numbers with a fraction, as printf has it
  int gap = 1;         // blanks before it in text
  bool quoted = true;  // its texts, in CSV
};

// A value of a table. Without one it is blank in text and not in JSON at all; an unknown one is "-" and null.
struct Cell {
  struct Unknown {};
  using Value = std::variant<std::monostate, Unknown, bool, std::uint64_t, double, std::string>;

  Cell() = default;
  Cell(bool value) : value(value) {}
  Cell(std::unsigned_integral auto value) : value(std::uint64_t{value}) {}
  Cell(double value) : value(value) {}
  Cell(std::string value) : value(std::move(value)) {}
  Cell(std::string_view value) : value(std::string(value)) {}
  Cell(const char* value) : value(std::string(value)) {}
  template <class T>
  Cell(const std::optional<T>& known) : value(known ? Cell(*known).value : Value(Unknown{})) {}

  // The same, but for what text and Markdown show.
  Cell shown_as(std::string text) && {
    shown = std::move(text);
    return std::move(*this);
  }

  Value value;
  std::optional<std::string> shown;
};

struct Row {
  std::vector<Cell> cells;           // in the order of the columns; those left out are without a value
  std::string remark{};              // in text, at the end of the line
  std::vector<std::string> below{};  // in text, lines of their own
};

// Rows and columns, declared once and written as text, CSV, JSON or Markdown.
class Table {
 public:
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  Row& add(Row row) { return rows_.emplace_back(std::move(row)); }
  // The column of the key, which comes last if it is new.
  std::size_t column(const Column& column);
  // The same value in every row there is.
  void set_all(const Column& column, const Cell& cell);
  const std::vector<Row>& rows() const { return rows_; }

  std::string text_header() const;
  std::string text(const Row& row) const;
  std::string text() const;  // all of it
  std::string csv() const;   // as RFC 4180 has it; without a line break at the end
  Json json() const;         // an array of rows
  Json json(const Row& row) const;
  std::string markdown() const;

 private:
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

// To stdout.
void print(const std::string& text);

// As printf does.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace coppice
