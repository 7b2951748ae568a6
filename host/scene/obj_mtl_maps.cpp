#include "scene/obj_mtl_maps.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "scene/obj_lines.h"

namespace coppice {
namespace {

// An option and what belongs to it: from `least` to `most` words, numbers or not.
struct MapOption {
  std::string_view name;
  std::size_t least, most;
  bool has_numbers;
  bool is_unused = false;
};

constexpr std::array MAP_OPTIONS = std::to_array<MapOption>({
    {"-o", 1, 3, true},
    {"-s", 1, 3, true},
    {"-clamp", 1, 1, false},
    {"-bm", 1, 1, true},
    {"-imfchan", 1, 1, false},
    {"-mm", 2, 2, true, true},
    {"-t", 1, 3, true, true},
    {"-blendu", 1, 1, false},
    {"-blendv", 1, 1, false},
    {"-boost", 1, 1, true},
    {"-cc", 1, 1, false},
    {"-texres", 1, 1, true},
    {"-type", 1, 1, false},
    {"-colorspace", 1, 1, false},
});

// Far beyond what an image is repeated, and no trouble for float.
constexpr float MOST_SCALE = 0x1p20f;

std::optional<float> map_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return std::abs(value) > MOST_SCALE ? std::copysign(MOST_SCALE, value) : value;
}

class MapStatement {
 public:
  explicit MapStatement(std::string_view statement) : rest_(trim(statement)) {}

  MtlMap read() {
    while (take_option()) {
    }
    if (rest_.size() > 2 && rest_.front() == '"' && rest_.back() == '"') {
      rest_ = rest_.substr(1, rest_.size() - 2);
    }
    TextureMap& map = result_.map;
    map.name = rest_;
    // The format's origin is the lower left corner.
    map.scale = {scale_.x, -scale_.y};
    map.offset = {offset_.x, 1 - offset_.y};
    return std::move(result_);
  }

 private:
  bool take_option() {
    Words words(rest_);
    const std::string name = lower_case(words.next());
    for (const MapOption& option : MAP_OPTIONS) {
      if (name == option.name) return take_words(option, words);
    }
    return false;
  }

  bool take_words(const MapOption& option, Words words) {
    std::string_view rest = words.rest(), word;
    std::array<float, 3> numbers{};
    std::size_t count = 0;
    for (; count < option.most; ++count) {
      const std::string_view next = words.next();
      if (next.empty()) break;
      if (option.has_numbers) {
        const std::optional<float> number = map_number(next);
        if (!number) break;
        numbers[count] = *number;
      }
      word = next;
      rest = words.rest();
    }
    if (count < option.least) return false;
    rest_ = trim(rest);
    apply(option, numbers, count, lower_case(word));
    return true;
  }

  void apply(const MapOption& option, const std::array<float, 3>& numbers, std::size_t count,
             const std::string& word) {
    TextureMap& map = result_.map;
    result_.has_unused |= option.is_unused;
    if (option.name == "-o") offset_ = {numbers[0], count > 1 ? numbers[1] : 0};
    if (option.name == "-s") scale_ = {numbers[0], count > 1 ? numbers[1] : 1};
    if (option.name == "-clamp") {
      map.wrap_u = map.wrap_v = word == "on" ? TextureWrap::clamp : TextureWrap::repeat;
    }
    if (option.name == "-bm") map.strength = numbers[0];
    if (option.name == "-imfchan" && word.size() == 1 && std::string_view("rgbmlz").find(word) < 6) {
      map.channel = word[0];
    }
  }

  std::string_view rest_;
  glm::vec2 offset_{0}, scale_{1};
  MtlMap result_;
};

}  // namespace

MtlMap parse_mtl_map(std::string_view statement) { return MapStatement(statement).read(); }

}  // namespace coppice
