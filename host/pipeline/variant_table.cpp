#include "pipeline/variant_table.h"

#include <sstream>
#include <vector>

#include "gpu/kept_file.h"

namespace coppice {

namespace {

constexpr std::uint64_t most_table_bytes = std::uint64_t{64} << 10;
constexpr const char* format_line = "coppice variants 1";

// A name in one line of its own.
std::string line_of(const char* what, std::string name) {
  for (char& c : name) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return std::string(what) + " " + name;
}

}  // namespace

std::string variant_table_text(const Variants& variants, const DeviceProperties& device) {
  std::string text = format_line;
  text += '\n' + line_of("device", device.name) + '\n' + line_of("driver", device.driver) + '\n';
  for (char c : to_string(variants)) text += c == ',' ? '\n' : c;
  return text + '\n';
}

std::string parse_variant_table(const std::string& text, const DeviceProperties& device, Variants& variants) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  if (lines.empty() || lines[0] != format_line) return "is no table of variants";
  if (lines.size() < 3 || lines[1] != line_of("device", device.name) ||
      lines[2] != line_of("driver", device.driver))
    return "is of another device or driver";
  Variants result = variants;
  std::size_t line = 3;
  for (const VariantStage& stage : variant_stages()) {
    if (line == lines.size() || !lines[line].starts_with(std::string(stage.name) + '='))
      return "has no line for the stage " + std::string(stage.name);
    if (std::string error = set_variants(lines[line++], result); !error.empty()) return "is wrong: " + error;
  }
  if (line != lines.size() || !text.ends_with('\n')) return "does not end where it should";
  variants = result;
  return {};
}

Variants variants_of(const Device& device, const std::function<void(const std::string&)>& note) {
  Variants variants = default_variants(device.properties());
  const std::filesystem::path path = device.kept_file("variants");
  if (path.empty()) return variants;
  const KeptFile kept = read_kept_file(path, most_table_bytes);
  if (!kept.found) return variants;
  const std::string error =
      kept.refused.empty() ? parse_variant_table(kept.bytes, device.properties(), variants) : kept.refused;
  if (!error.empty() && note) note(path.string() + " " + error + "; ignored (coppice tune writes it anew)");
  return variants;
}

}  // namespace coppice
