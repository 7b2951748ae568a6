#include "pipeline/verdicts.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "gpu/kept_file.h"
#include "stages/stages.h"

namespace coppice {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_verdict_bytes = std::uint64_t{1} << 20;

// By the kernels' words: a verdict on others says nothing.
std::string kernels_hash() {
  std::uint64_t hash = 14695981039346656037u;
  for (const StageDeclaration* const stage : all_stages()) {
    for (const std::uint32_t word : stage->kernel) hash = (hash ^ word) * 1099511628211u;
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::string head_of(const DeviceProperties& device) {
  std::string head = "coppice verdicts 1 " + kernels_hash() + ' ' + device.name + ", " + device.driver;
  for (char& c : head) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return head + (device.shared_memory ? "" : " like a GPU");
}

// Verdicts by use; empty for a file of others.
std::map<std::string, bool> read_verdicts(const fs::path& path, const std::string& head) {
  std::istringstream stream(read_kept_file(path, most_verdict_bytes).bytes);
  std::map<std::string, bool> verdicts;
  std::string line;
  if (!std::getline(stream, line) || line != head) return verdicts;
  while (std::getline(stream, line)) {
    const std::size_t space = line.rfind(' ');
    if (space == std::string::npos || (line.substr(space) != " 0" && line.substr(space) != " 1")) return {};
    verdicts[line.substr(0, space)] = line.back() == '1';
  }
  return verdicts;
}

// Whole or not at all; a folder that cannot be written is left alone.
void write_verdicts(const fs::path& path, const std::string& head,
                    const std::map<std::string, bool>& verdicts) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  static std::atomic<std::uint64_t> writes = 0;  // several contexts of a process may write at once
  const fs::path partial = path.string() + '.' + std::to_string(getpid()) + '.' + std::to_string(++writes);
  std::ofstream file(partial, std::ios::binary | std::ios::trunc);
  file << head << '\n';
  for (const auto& [use, lookback] : verdicts) file << use << ' ' << lookback << '\n';
  file.close();
  if (file) fs::rename(partial, path, error);
  if (!file || error) fs::remove(partial, error);
}

}  // namespace

std::string line_of(const DeviceUse& use) {
  std::ostringstream text;
  const BuildOptions& build = use.build;
  text << "build:" << use.builds << ':' << static_cast<int>(build.builder) << ':' << build.radius << ':'
       << build.morton_bits << ':' << build.lookback_turns << ':' << build.lookback_max_fallbacks << ':'
       << build.lookback_stress << ':' << to_string(build.variants);
  for (const TraceOptions& trace : use.traces) {
    text << ";trace:" << name_of(trace.walk) << ':' << trace.max_turns << ':' << trace.visits_per_turn << ':'
         << trace.stack_entries << ':' << trace.triangle_test << ':' << trace.box_test;
  }
  text << ";others:" << use.wide << use.refits << use.inputs << use.batches << use.sorts << use.sorts_values
       << use.scans << use.every_ray << use.vertices << use.instances;
  return text.str();
}

bool kept_check_device(Device& device, const DeviceUse& use) {
  const fs::path path = device.kept_file("verdicts");
  if (path.empty()) return check_device(device, use);
  const std::string head = head_of(device.properties()), name = line_of(use);
  std::map<std::string, bool> verdicts = read_verdicts(path, head);
  if (const auto kept = verdicts.find(name); kept != verdicts.end()) return kept->second;
  const bool lookback = check_device(device, use);
  verdicts[name] = lookback;
  write_verdicts(path, head, verdicts);
  return lookback;
}

}  // namespace coppice
