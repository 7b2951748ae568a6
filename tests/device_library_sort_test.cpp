// Sorts and scans that the library records, and what it is told that cannot be: by name, and nothing written.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <random>

#include "coppice/scan.h"
#include "coppice/sort.h"
#include "coppice/trace.h"
#include "support/library_device.h"
#include "support/test_device.h"

namespace coppice {
namespace {

class LibrarySort : public LibraryTest {};
class LibraryScan : public LibraryTest {};
class LibraryErrors : public LibraryTest {};

// Pairs of random keys with ties, of which `count` are sorted.
void expect_sorted(const Sorter& sorter, const SortOptions& options, std::uint32_t maximum,
                   std::uint32_t count, consumer::OwnDevice& own, bool on_device) {
  std::mt19937 random(count);
  const std::uint32_t words = options.key_words;
  std::vector<std::uint32_t> keys(std::size_t{maximum} * words), values(maximum), order(count);
  for (std::uint32_t i = 0; i < maximum; ++i) {
    for (std::uint32_t w = 0; w < words; ++w)
      keys[i * words + w] = random() & (w == 0 && words == 2 ? 0x00f000ffu : 0x3fffffffu);
    values[i] = i * 3;
  }
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    return words == 1 ? std::uint64_t{keys[i]} : std::uint64_t{keys[2 * i + 1]} << 32 | keys[2 * i];
  };
  std::ranges::stable_sort(order, {}, key);
  const auto key_memory = own.upload(std::span<const std::uint32_t>(keys));
  const auto value_memory = own.upload(std::span<const std::uint32_t>(values));
  const auto count_memory = own.upload(std::span<const std::uint32_t>(&count, 1));
  const auto scratch = own.make_buffer(sorter.scratch_bytes());
  const VkCommandBuffer commands = own.begin();
  sorter.cmd_sort(commands, key_memory.address, options.values ? value_memory.address : 0,
                  {on_device ? maximum : count, on_device ? count_memory.address : 0},
                  {scratch.buffer, 0, scratch.bytes});
  own.run(commands);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t w = 0; w < words; ++w)
      ASSERT_EQ(key_memory.as<std::uint32_t>()[i * words + w], keys[order[i] * words + w]) << i;
    if (options.values) {
      ASSERT_EQ(value_memory.as<std::uint32_t>()[i], values[order[i]]) << i;
    }
  }
  for (std::uint32_t i = count; i < maximum; ++i)
    ASSERT_EQ(key_memory.as<std::uint32_t>()[i * words], keys[i * words]) << i;
  const auto& state = scratch.as<CoppiceTreeState>(sorter.state_address({scratch.buffer, 0, scratch.bytes}) -
                                                   scratch.address)[0];
  EXPECT_EQ(state.error_word, 0u);
}

TEST_F(LibrarySort, OfPairsAndOfKeysAlone) {
  for (const SortOptions options : {SortOptions{1, true}, SortOptions{1, false}, SortOptions{2, true}}) {
    constexpr std::uint32_t maximum = 70000;
    const Sorter sorter(context(), maximum, options);
    for (const std::uint32_t count : {0u, 1u, 3u, 16384u, 16385u, maximum}) {
      expect_sorted(sorter, options, maximum, count, own(), false);
      expect_sorted(sorter, options, maximum, count, own(), true);
    }
  }
}

TEST_F(LibraryScan, OfAnyNumberOfWords) {
  constexpr std::uint32_t maximum = 100000;
  const Scanner scanner(context(), maximum);
  const auto scratch = own().make_buffer(scanner.scratch_bytes());
  std::vector<std::uint32_t> words(maximum);
  for (std::uint32_t i = 0; i < maximum; ++i) words[i] = i * 2654435761u;
  const auto source = upload(words);
  for (const std::uint32_t count : {0u, 1u, 5u, 16385u, maximum}) {
    for (const bool on_device : {false, true}) {
      const auto target = own().make_buffer(maximum * 4 + 256);
      std::ranges::fill(target.as<std::uint32_t>(), 0xabababab);
      const auto count_memory = upload(std::vector<std::uint32_t>{count});
      const VkCommandBuffer commands = own().begin();
      scanner.cmd_scan(commands, source.address, target.address,
                       {on_device ? maximum : count, on_device ? count_memory.address : 0},
                       range_of(scratch));
      own().run(commands);
      std::uint32_t sum = 0;
      for (std::uint32_t i = 0; i < count; sum += words[i++])
        ASSERT_EQ(target.as<std::uint32_t>()[i], sum) << count << ", " << i;
      EXPECT_EQ(target.as<std::uint32_t>()[count], 0xabababab) << count;
    }
  }
}

// The message of what the action throws; empty if it throws nothing.
template <class Thrown, class Action>
std::string thrown_by(Action action) {
  try {
    action();
  } catch (const Thrown& error) {
    return error.what();
  }
  return {};
}

TEST_F(LibraryErrors, BadArgumentsAreNamedAndNothingIsRecorded) {
  const Builder builder(context(), 1000);
  const BuildSizes sizes = builder.sizes();
  const auto tree = own().make_buffer(sizes.tree_bytes + 4096),
             scratch = own().make_buffer(sizes.scratch_bytes);
  const auto triangles = upload(random_triangles(1000, 1));
  TriangleInput good;
  good.vertices = triangles.address;
  good.vertex_count = 3000;
  good.count.maximum = 1000;
  const VkCommandBuffer commands = own().begin();
  const auto message = [&](const TriangleInput& input, const MemoryRange& tree_range,
                           const MemoryRange& scratch_range) {
    return thrown_by<ArgumentError>([&] { builder.cmd_build(commands, input, tree_range, scratch_range); });
  };
  const auto expect_named = [&](const char* name, auto change) {
    TriangleInput input = good;
    change(input);
    EXPECT_TRUE(message(input, range_of(tree), range_of(scratch)).starts_with(name))
        << name << " | " << message(input, range_of(tree), range_of(scratch));
  };
  expect_named("count: 1001 are more than the maximum, 1000",
               [](TriangleInput& i) { i.count.maximum = 1001; });
  expect_named("count: the address is no multiple of 4", [](TriangleInput& i) { i.count.address = 2; });
  expect_named("vertices: the address is null", [](TriangleInput& i) { i.vertices = 0; });
  expect_named("vertices: the address is no multiple of 4", [](TriangleInput& i) { i.vertices += 2; });
  expect_named("vertex_stride: 8", [](TriangleInput& i) { i.vertex_stride = 8; });
  expect_named("vertex_stride: 14", [](TriangleInput& i) { i.vertex_stride = 14; });
  expect_named("indices: the address is no multiple of 4", [](TriangleInput& i) { i.indices = 6; });
  expect_named("index_type: ", [](TriangleInput& i) { i.index_type = VK_INDEX_TYPE_NONE_KHR; });
  expect_named("transform: the address is no multiple of 4", [](TriangleInput& i) { i.transform = 1; });
  const std::string needed = std::to_string(sizes.tree_bytes) + " bytes are needed";
  EXPECT_NE(message(good, {tree.buffer, 0, sizes.tree_bytes - 1}, range_of(scratch)).find("tree: "),
            std::string::npos);
  EXPECT_NE(message(good, {tree.buffer, 0, sizes.tree_bytes - 1}, range_of(scratch)).find("bytes are needed"),
            std::string::npos);
  EXPECT_EQ(message(good, {tree.buffer, 16, sizes.tree_bytes}, range_of(scratch)),
            "tree: the address is no multiple of 256");
  EXPECT_EQ(message(good, {VK_NULL_HANDLE, 0, sizes.tree_bytes}, range_of(scratch)),
            "tree: the buffer is null");
  EXPECT_NE(message(good, range_of(tree), {scratch.buffer, 0, 16}).find("scratch: "), std::string::npos);
  EXPECT_EQ(message(good, range_of(scratch), range_of(scratch)),
            "scratch: it overlaps other memory of the call");
  KernelQueries no_pool{.capacity = 5};
  EXPECT_EQ(thrown_by<ArgumentError>(
                [&] { builder.cmd_build(commands, good, range_of(tree), range_of(scratch), &no_pool); }),
            "queries: the pool is null");
  own().run(commands);
  EXPECT_TRUE(std::ranges::all_of(tree.as<std::uint8_t>(), [](std::uint8_t byte) { return byte == 0; }));

  const Tracer tracer(context());
  RayInput rays;
  rays.rays = triangles.address;
  rays.count.maximum = MAX_RAYS + 1;
  EXPECT_EQ(thrown_by<ArgumentError>([&] {
              tracer.cmd_trace_closest(commands, builder.triangle_tree(range_of(tree)), rays, tree.address,
                                       range_of(scratch));
            }),
            "count: 4194241 are more than the maximum, 4194240");
  EXPECT_NE(thrown_by<ArgumentError>([&] { Builder(context(), 1000, {.radius = 101}); }).find("radius 101"),
            std::string::npos);
  EXPECT_NE(thrown_by<ArgumentError>([&] { Builder(context(), 1000, {.morton_bits = 31}); }).find("31"),
            std::string::npos);
  EXPECT_NE(thrown_by<ArgumentError>([&] { Builder(context(), 67107841); }).find("67107841"),
            std::string::npos);
  EXPECT_NE(thrown_by<ArgumentError>([&] {
              Sorter(context(), 10, {3, true});
            }).find("key_words"),
            std::string::npos);
  const Sorter of_keys(context(), 10, {1, false});
  EXPECT_EQ(thrown_by<ArgumentError>([&] {
              of_keys.cmd_sort(commands, triangles.address, tree.address, {10}, range_of(scratch));
            }),
            "values: this sorter sorts keys alone");
}

// Memory around what was given stays as it is, whatever a call does in it.
TEST_F(LibraryErrors, NothingIsWrittenOutsideOfWhatWasGiven) {
  constexpr std::uint32_t maximum = 3000, guard = 4096;
  const std::vector<Triangle> triangles = random_triangles(maximum, 2);
  const auto memory = upload(triangles);
  for (const DeviceBuilder by : {DeviceBuilder::ploc, DeviceBuilder::hploc, DeviceBuilder::lbvh}) {
    const Builder builder(context(), maximum, {.builder = by, .wide = true});
    for (const std::uint32_t count : {0u, 1u, maximum, maximum + 5000}) {
      const auto tree = own().make_buffer(builder.sizes().tree_bytes + 2 * guard);
      const auto scratch = own().make_buffer(builder.sizes().scratch_bytes + 2 * guard);
      for (const consumer::Buffer& one : {tree, scratch}) std::ranges::fill(one.as<std::uint8_t>(), 0xcd);
      TriangleInput input;
      input.vertices = memory.address;
      input.vertex_count = 3 * maximum;
      input.count = {maximum, upload(std::vector<std::uint32_t>{count}).address};
      const VkCommandBuffer commands = own().begin();
      builder.cmd_build(commands, input, {tree.buffer, guard, builder.sizes().tree_bytes},
                        {scratch.buffer, guard, builder.sizes().scratch_bytes});
      own().run(commands);
      for (const consumer::Buffer& one : {tree, scratch}) {
        const auto bytes = one.as<std::uint8_t>();
        const auto untouched = [](std::uint8_t byte) { return byte == 0xcd; };
        EXPECT_TRUE(std::ranges::all_of(bytes.first(guard), untouched));
        EXPECT_TRUE(std::ranges::all_of(bytes.last(guard), untouched));
      }
    }
  }
}

TEST_F(LibraryErrors, ADeviceThatLacksAFeatureIsRefusedByItsName) {
  AdoptedDevice device = adopted();
  RequiredFeatures lacking;
  lacking.vulkan12.scalarBlockLayout = VK_FALSE;
  device.enabled_features = &lacking.features;
  EXPECT_EQ(missing_feature(lacking.features), "scalarBlockLayout");
  EXPECT_EQ(missing_feature(features().features), "");
  EXPECT_NE(
      thrown_by<DeviceError>([&] { Context{device}; }).find("the feature scalarBlockLayout is not enabled"),
      std::string::npos);
  auto bare = consumer::structure<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  EXPECT_EQ(missing_feature(bare), "shaderInt64");
  device.enabled_features = nullptr;
  EXPECT_NE(thrown_by<DeviceError>([&] { Context{device}; }).find("enabled_features is null"),
            std::string::npos);
  device = adopted();
  device.queue_family = 99;
  EXPECT_NE(thrown_by<DeviceError>([&] { Context{device}; }).find("queue family 99"), std::string::npos);
  EXPECT_NE(thrown_by<DeviceError>([&] { Context(AdoptedDevice{}); }).find("needs an instance"),
            std::string::npos);
  EXPECT_EQ(why_unsuitable(own().instance, own().physical), "");
}

TEST_F(LibraryErrors, WithoutAQueueNothingIsCheckedAndTheLogSaysSo) {
  AdoptedDevice device = adopted();
  device.queue = VK_NULL_HANDLE;
  std::vector<std::string> lines;
  ContextOptions options;
  options.log = [&](std::string_view line) { lines.emplace_back(line); };
  const Context unchecked(device, options);
  const Scanner scanner(unchecked, 100);
  // Without lookback a sort of few keys would have an odd number of passes, and not end where it began.
  const Sorter sorter(unchecked, 20000);
  expect_sorted(sorter, {}, 20000, 20000, own(), false);
  expect_sorted(sorter, {}, 20000, 300, own(), true);
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines[0].find("no queue was given"), std::string::npos);
  EXPECT_EQ(unchecked.queue(), VK_NULL_HANDLE);
}

TEST_F(LibraryErrors, VerdictsAreKeptByDriver) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("coppice_verdicts_" + std::to_string(std::random_device()()));
  ContextOptions options;
  options.cache_folder = folder;
  const auto kept = [&] {
    std::string text;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (!entry.path().filename().string().starts_with("verdicts-")) continue;
      std::ifstream file(entry.path());
      text.assign(std::istreambuf_iterator<char>(file), {});
    }
    return text;
  };
  {
    const Context first(adopted(), options);
    const Builder builder(first, 100);
  }
  const std::string verdicts = kept();
  EXPECT_TRUE(verdicts.starts_with("coppice verdicts 1 "));
  EXPECT_EQ(std::ranges::count(verdicts, '\n'), 2);
  {
    const Context second(adopted(), options);
    const Builder builder(second, 200), hploc(second, 200, {.builder = DeviceBuilder::hploc});
  }
  EXPECT_TRUE(kept().starts_with(verdicts.substr(0, verdicts.find('\n'))));
  EXPECT_EQ(std::ranges::count(kept(), '\n'), 3);  // one for each use
  std::filesystem::remove_all(folder);
}

TEST_F(LibraryErrors, AContextMayMakeADeviceOfItsOwn) {
  Context context({.validate = true});
  EXPECT_NE(context.capabilities().name, "");
  EXPECT_NE(context.queue(), VK_NULL_HANDLE);
  { const Builder builder(context, 10); }
  EXPECT_EQ(context.take_validation_messages(), std::vector<std::string>());
  EXPECT_NE(thrown_by<DeviceError>([] { Context({.select = "no such device"}); }).find("no such device"),
            std::string::npos);
}

}  // namespace
}  // namespace coppice
