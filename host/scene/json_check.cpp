#include "scene/json_check.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "scene/input_error.h"
#include "scene/printable.h"

namespace coppice {
namespace {

using nlohmann::json;

// What the parser says, without its own names, behind the place.
std::string syntax_error(const std::string& name, const std::string& what) {
  std::size_t line = 0, column = 0;
  const std::size_t at = what.find("at line ");
  std::string rest = what;
  if (at != std::string::npos &&
      std::sscanf(what.c_str() + at, "at line %zu, column %zu", &line, &column) == 2) {
    const std::size_t colon = what.find(": ", at);
    if (colon != std::string::npos) rest = what.substr(colon + 2);
    return name + ":" + std::to_string(line) + ":" + std::to_string(column) +
           ": no JSON: " + printable(std::filesystem::path(rest.substr(0, 200)));
  }
  const std::size_t bracket = what.find("] ");
  return name + ": no JSON: " + printable(std::filesystem::path(what.substr(bracket + 2, 200)));
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  }
  return text;
}

const json& resolved(const json& root, const json& schema) {
  const auto reference = schema.find("$ref");
  if (reference == schema.end()) return schema;
  return root.at(json::json_pointer(reference->get<std::string>().substr(1)));
}

std::string number_text(const json& number) { return number.dump(); }

std::string range_of(const json& schema) {
  std::string text;
  if (schema.contains("exclusiveMinimum")) text = " above " + number_text(schema["exclusiveMinimum"]);
  if (schema.contains("exclusiveMaximum")) text += " below " + number_text(schema["exclusiveMaximum"]);
  const bool low = schema.contains("minimum"), high = schema.contains("maximum");
  if (low && high)
    return text + " from " + number_text(schema["minimum"]) + " to " + number_text(schema["maximum"]);
  if (low) text += " of at least " + number_text(schema["minimum"]);
  if (high) text += " of at most " + number_text(schema["maximum"]);
  return text;
}

std::string expected_of(const json& root, const json& unresolved);

std::string expected_array(const json& root, const json& schema) {
  std::string text = "an array";
  const auto least = schema.value("minItems", 0), most = schema.value("maxItems", 0);
  if (least > 0 && least == most) {
    text += " of " + std::to_string(least);
  } else if (most > 0) {
    text += " of " + std::to_string(least) + " to " + std::to_string(most);
  } else if (least > 0) {
    text += " of at least " + std::to_string(least);
  }
  if (!schema.contains("items")) return text;
  return text + (least + most > 0 ? ", each " : " of ") + expected_of(root, schema["items"]);
}

std::string expected_of(const json& root, const json& unresolved) {
  const json& schema = resolved(root, unresolved);
  if (schema.contains("description")) return schema["description"].get<std::string>();
  std::vector<std::string> words;
  if (schema.contains("enum")) {
    for (const json& value : schema["enum"]) words.push_back(value.dump());
    return joined(words);
  }
  if (schema.contains("const")) return schema["const"].dump();
  json types = schema.value("type", json::array());
  if (types.is_string()) types = json::array({types});
  for (const json& type : types) {
    if (type == "array") {
      words.push_back(expected_array(root, schema));
    } else if (type == "object") {
      words.push_back("an object");
    } else if (type == "boolean") {
      words.push_back("true or false");
    } else if (type == "string") {
      words.push_back(schema.contains("minLength") ? "a string that is not empty" : "a string");
    } else {
      words.push_back((type == "integer" ? "an integer" : "a number") + range_of(schema));
    }
  }
  return joined(words);
}

// A place in the document, with what the schema says of it.
struct SchemaPlace {
  std::string pointer;
  const json* value;
  const json* schema;  // null: nothing
};

SchemaPlace find_place(const json& document, const json& root, const std::vector<std::string>& context) {
  SchemaPlace place{"", &document, &root};
  for (std::size_t i = 1; i < context.size(); ++i) {
    const std::string key = context[i].substr(1, context[i].size() - 2);  // "[key]"
    const json* const parent = place.schema;
    place.schema = nullptr;
    if (place.value->is_array()) {
      const std::size_t index = std::stoul(key);
      place.value = &place.value->at(index);
      if (parent && parent->contains("items")) place.schema = &resolved(root, (*parent)["items"]);
    } else {
      place.value = &place.value->at(key);
      if (parent && parent->contains("properties") && (*parent)["properties"].contains(key)) {
        place.schema = &resolved(root, (*parent)["properties"][key]);
      } else if (parent && parent->contains("additionalProperties") &&
                 (*parent)["additionalProperties"].is_object()) {
        place.schema = &resolved(root, (*parent)["additionalProperties"]);
      }
    }
    place.pointer += pointer_step(key);
  }
  return place;
}

// Of an object: the first key that may not or must be there.
void check_keys(const SchemaPlace& place, const std::string& name) {
  const json& schema = *place.schema;
  for (const json& key : schema.value("required", json::array())) {
    if (!place.value->contains(key.get<std::string>())) {
      fail_at(name, place.pointer, "key " + key.dump() + " is missing, it is required here");
    }
  }
  if (schema.value("additionalProperties", json(true)) != json(false)) return;
  std::vector<std::string> known;
  const json properties = schema.value("properties", json::object());
  for (const auto& [key, unused] : properties.items()) known.push_back(key);
  for (const auto& [key, unused] : place.value->items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      fail_at(name, place.pointer + pointer_step(key), "unknown key, expected " + joined(known));
    }
  }
}

}  // namespace

void fail_at(const std::string& name, const std::string& pointer, const std::string& what) {
  throw InputError(name + ": " + (pointer.empty() ? "" : pointer + ": ") + what);
}

std::string pointer_step(std::string_view key) {
  std::string step = "/";
  for (const char c : printable(key)) step += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return step;
}

std::string shortened(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array() && value.size() > 16) return "an array of " + std::to_string(value.size());
  return printable(std::string_view(value.dump(-1, ' ', false, json::error_handler_t::replace)));
}

json parse_json(std::string_view text, const std::string& name) {
  struct Level {
    std::string pointer;  // of the object or array
    std::set<std::string> keys;
  };
  std::vector<Level> levels;
  std::string key;
  const auto watch = [&](int, json::parse_event_t event, const json& parsed) {
    switch (event) {
      case json::parse_event_t::object_start:
      case json::parse_event_t::array_start:
        if (levels.size() == MAX_JSON_DEPTH) {
          fail_at(name, levels.back().pointer,
                  "nested too deep, expected at most " + std::to_string(MAX_JSON_DEPTH) + " levels");
        }
        levels.push_back({levels.empty() ? "" : levels.back().pointer + key, {}});
        key.clear();
        break;
      case json::parse_event_t::key:
        key = pointer_step(parsed.get_ref<const std::string&>());
        if (!levels.back().keys.insert(parsed.get<std::string>()).second) {
          fail_at(name, levels.back().pointer + key, "given twice, expected each key once");
        }
        break;
      case json::parse_event_t::object_end:
      case json::parse_event_t::array_end:
        levels.pop_back();
        break;
      default:
        break;
    }
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), watch);
  } catch (const json::exception& error) {
    throw InputError(syntax_error(name, error.what()));
  }
}

void check_schema(const json& document, std::string_view schema_text, const std::string& name) {
  const json root = json::parse(schema_text);
  valijson::Schema schema;
  valijson::SchemaParser parser;
  const valijson::adapters::NlohmannJsonAdapter root_adapter(root);
  parser.populateSchema(root_adapter, schema);
  valijson::Validator validator;
  valijson::ValidationResults results;
  const valijson::adapters::NlohmannJsonAdapter adapter(document);
  if (validator.validate(schema, adapter, &results)) return;
  const valijson::ValidationResults::Error* deepest = nullptr;
  for (const auto& error : results) {
    if (!deepest || error.context.size() > deepest->context.size()) deepest = &error;
  }
  if (!deepest) fail_at(name, "", "does not fit its schema");
  const SchemaPlace place = find_place(document, root, deepest->context);
  if (!place.schema) fail_at(name, place.pointer, printable(std::string_view(deepest->description)));
  if (place.value->is_object()) check_keys(place, name);
  fail_at(name, place.pointer, shortened(*place.value) + ", expected " + expected_of(root, *place.schema));
}

}  // namespace coppice
