// Changes JSON where libFuzzer by itself would mostly break its syntax: one value somewhere becomes another
// one, is taken out or doubled. Half of the inputs, and what is no JSON, are changed by the byte as ever.
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t most);

namespace {

using nlohmann::json;

void collect(json& value, std::vector<json*>& all) {
  all.push_back(&value);
  if (value.is_structured()) {
    for (json& child : value) collect(child, all);
  }
}

json odd_value(std::minstd_rand& random) {
  static const json values = {0,
                              1,
                              2,
                              3,
                              4,
                              7,
                              255,
                              256,
                              -1,
                              0.5,
                              -0.5,
                              65535,
                              65536,
                              2147483647,
                              1e30,
                              -1e30,
                              1e-300,
                              1e308,
                              5121,
                              5126,
                              5123,
                              "a",
                              "",
                              true,
                              nullptr,
                              "VEC3",
                              "SCALAR",
                              "CUBICSPLINE",
                              "STEP",
                              json::array(),
                              json::object(),
                              {0, 0, 0},
                              {0, 0, 0, 1}};
  return values[random() % values.size()];
}

void change(json& document, std::minstd_rand& random) {
  std::vector<json*> all;
  collect(document, all);
  json& value = *all[random() % all.size()];
  switch (random() % 4) {
    case 0:
      value = odd_value(random);
      break;
    case 1: {
      const json other = *all[random() % all.size()];
      value = other;
      break;
    }
    case 2:
      if (value.is_array() && !value.empty()) {
        const json element = value[random() % value.size()];
        value.push_back(element);
      } else if (value.is_number_integer()) {
        value = value.get<std::int64_t>() / 2 + static_cast<std::int64_t>(random() % 3);
      }
      break;
    default:
      if (value.is_array() && !value.empty()) value.erase(random() % value.size());
      if (value.is_object() && !value.empty()) {
        auto at = value.begin();
        std::advance(at, static_cast<std::ptrdiff_t>(random() % value.size()));
        value.erase(at);
      }
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size, std::size_t most,
                                               unsigned seed) {
  std::minstd_rand random(seed);
  if (random() % 2 == 0) return LLVMFuzzerMutate(bytes, size, most);
  json document = json::parse(bytes, bytes + size, nullptr, false);
  if (document.is_discarded()) return LLVMFuzzerMutate(bytes, size, most);
  for (unsigned i = 0; i <= random() % 4; ++i) change(document, random);
  const std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > most) return LLVMFuzzerMutate(bytes, size, most);
  std::memcpy(bytes, text.data(), text.size());
  return text.size();
}
