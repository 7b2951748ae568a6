// The table that coppice tune writes is read back as it was, and one that is not whole or of another device
// is none.
#include <gtest/gtest.h>

#include "pipeline/variant_table.h"

namespace coppice {
namespace {

DeviceProperties device_named(const std::string& name, DeviceType type = DeviceType::cpu,
                              std::uint32_t subgroup_size = 8) {
  DeviceProperties device{};
  device.name = name;
  device.driver = "driver 1.2";
  device.type = type;
  device.subgroup_size = subgroup_size;
  return device;
}

TEST(Variants, RulesGoByPropertiesOfTheDevice) {
  EXPECT_EQ(default_variants(device_named("a")).sort, SORT_SCAN);
  EXPECT_EQ(default_variants(device_named("a", DeviceType::discrete, 32)).sort, SORT_ONESWEEP_MATCH);
  EXPECT_EQ(default_variants(device_named("a", DeviceType::integrated, 8)).sort, SORT_ONESWEEP_RUNS);
  EXPECT_EQ(default_variants(device_named("a")).walk(), Walk::wide_packets);
  EXPECT_EQ(default_variants(device_named("a", DeviceType::discrete, 32)).walk(), Walk::wide_single);
  EXPECT_EQ(default_variants(device_named("a", DeviceType::integrated, 8)).walk(), Walk::binary);
  DeviceProperties ends_loops = device_named("a");
  ends_loops.loop_turn_limit = 65535;
  EXPECT_EQ(default_variants(ends_loops).walk(), Walk::binary);
}

TEST(Variants, EveryValueOfEveryStageHasANameThatSetsIt) {
  for (const VariantStage& stage : variant_stages()) {
    for (std::uint32_t value = 0; value < stage.values.size(); ++value) {
      Variants variants, read;
      variants.*stage.value = value;
      EXPECT_EQ(set_variants(to_string(variants), read), "");
      EXPECT_EQ(read, variants);
    }
  }
}

TEST(Variants, WhatIsWrongIsNamedAndChangesNothing) {
  Variants variants;
  for (const char* text :
       {"", "sort", "sort=", "sort=scan,", "nonsense=scan", "sort=nonsense", "sort=scan-8,x=y"}) {
    EXPECT_NE(set_variants(text, variants), "") << text;
    EXPECT_EQ(variants, Variants()) << text;
  }
}

TEST(VariantTable, IsReadBackAsItWas) {
  const DeviceProperties device = device_named("of two\nlines");
  for (const VariantStage& stage : variant_stages()) {
    for (std::uint32_t value = 0; value < stage.values.size(); ++value) {
      Variants variants, read;
      variants.*stage.value = value;
      EXPECT_EQ(parse_variant_table(variant_table_text(variants, device), device, read), "");
      EXPECT_EQ(read, variants);
    }
  }
}

TEST(VariantTable, CorruptAndForeignOnesAreNone) {
  const DeviceProperties device = device_named("a");
  Variants tuned;
  tuned.sort = SORT_SCAN_11;
  const std::string good = variant_table_text(tuned, device);
  Variants variants;
  const auto refused = [&](const std::string& text, const DeviceProperties& of, const char* because) {
    const std::string error = parse_variant_table(text, of, variants);
    EXPECT_FALSE(error.empty()) << text;
    EXPECT_NE(error.find(because), std::string::npos) << "'" << error << "' of\n" << text;
    EXPECT_EQ(variants, Variants());
  };
  for (std::size_t bytes = 0; bytes < good.size(); ++bytes) refused(good.substr(0, bytes), device, "");
  refused("", device, "is no table");
  refused("nonsense\n", device, "is no table");
  refused(good, device_named("b"), "another device");
  refused(good + "trace=binary\n", device, "end");
  refused(good + "\n", device, "end");
  std::string other = good;
  other.replace(other.find("scan-11"), 7, "scan-12");
  refused(other, device, "no variant 'scan-12'");
}

}  // namespace
}  // namespace coppice
