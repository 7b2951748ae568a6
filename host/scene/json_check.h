#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace coppice {

// Reads JSON. Throws InputError "NAME:LINE:COLUMN: ..." where it is none, and "NAME: POINTER: ..." where a
// key is given twice or values are nested more than MAX_JSON_DEPTH deep.
inline constexpr int MAX_JSON_DEPTH = 64;
nlohmann::json parse_json(std::string_view text, const std::string& name);

// Checks a document against a JSON Schema (draft 7, with references into its own definitions, without anyOf
// and the like). Throws InputError "NAME: POINTER: ..." for the innermost of what does not fit, with what the
// schema expects there.
void check_schema(const nlohmann::json& document, std::string_view schema, const std::string& name);

// Throws InputError "NAME: POINTER: WHAT", for a place in a JSON document (RFC 6901).
[[noreturn]] void fail_at(const std::string& name, const std::string& pointer, const std::string& what);

// A key as a step of a JSON pointer, with the slash.
std::string pointer_step(std::string_view key);

// A value in short, for messages.
std::string shortened(const nlohmann::json& value);

}  // namespace coppice
