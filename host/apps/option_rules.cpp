#include "apps/option_rules.h"

namespace coppice {

namespace {

bool is_given(const CLI::App& app, std::string_view option) {
  const CLI::Option* const found = app.get_option_no_throw(std::string(option));
  return found && found->count() > 0;
}

}  // namespace

void check_options_matter(const CLI::App& app, std::initializer_list<OptionRule> rules) {
  for (const OptionRule& rule : rules) {
    if (is_given(app, rule.option) && !rule.matters)
      throw CLI::ValidationError(std::string(rule.option) + " does nothing here: it needs " + rule.needs);
  }
}

}  // namespace coppice
