#include "apps/option_groups.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "builders/registry.h"
#include "interface/ploc.h"
#include "pipeline/build_plan.h"
#include "scene/input_error.h"

namespace coppice {
namespace {

template <class T>
struct Word {
  const char* word;
  T value;
};

constexpr Word<LookbackChoice> lookback_words[] = {
    {"auto", LookbackChoice::automatic}, {"on", LookbackChoice::on}, {"off", LookbackChoice::off}};
constexpr Word<std::uint32_t> morton_words[] = {{"auto", 0}, {"30", 30}, {"60", 60}};
constexpr Word<std::uint32_t> triangle_test_words[] = {
    {"auto", TRIANGLE_WATERTIGHT}, {"fast", TRIANGLE_FAST}, {"watertight", TRIANGLE_WATERTIGHT}};
constexpr Word<std::uint32_t> box_test_words[] = {
    {"auto", BOX_ROBUST}, {"fast", BOX_FAST}, {"robust", BOX_ROBUST}};
constexpr Word<std::uint32_t> tone_curve_words[] = {{TONE_CURVE_NAMES[TONE_NONE], TONE_NONE},
                                                    {TONE_CURVE_NAMES[TONE_REINHARD], TONE_REINHARD},
                                                    {TONE_CURVE_NAMES[TONE_ACES], TONE_ACES}};

template <class T, std::size_t N>
std::string word_of(const Word<T> (&words)[N], T value) {
  return std::ranges::find(words, value, &Word<T>::value)->word;
}

// An option that takes one of a few words, the first if not given.
template <class T, std::size_t N>
void add_words(CLI::App& app, const std::string& name, T& value, const Word<T> (&words)[N],
               const std::string& help) {
  std::vector<std::string> names;
  for (const Word<T>& word : words) names.emplace_back(word.word);
  value = words[0].value;
  const auto set = [&value, &words](const std::string& given) {
    value = std::ranges::find(words, given, &Word<T>::word)->value;
  };
  app.add_option_function<std::string>(name, set, help)->check(CLI::IsMember(names))->default_str(names[0]);
}

// The whole text; infinity and NaN are none.
std::optional<double> number_of(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data() + text.starts_with('+'), end, number);
  return error == std::errc() && last == end && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

void add_limit(CLI::App& app, const char* name, double& value, double most, const std::string& help) {
  app.add_option(name, value, help)->check([most](const std::string& text) {
    const std::optional<double> number = number_of(text);
    return number && *number > 0 && *number <= most
               ? ""
               : "'" + text + "' is no number above 0 and up to " + std::to_string(static_cast<int>(most));
  });
}

}  // namespace

std::string word_of_lookback(LookbackChoice lookback) { return word_of(lookback_words, lookback); }
std::string word_of_triangle_test(std::uint32_t test) { return word_of(triangle_test_words, test); }
std::string word_of_box_test(std::uint32_t test) { return word_of(box_test_words, test); }
std::string word_of_morton_bits(std::uint32_t bits) { return word_of(morton_words, bits); }

void add_update(CLI::App& app, Update& update) {
  app.add_option("--update", update,
                 "where triangles have moved: a new tree, the old one refitted, or what costs less")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Update>{
          {"rebuild", Update::rebuild}, {"refit", Update::refit}, {"auto", Update::automatic}}))
      ->type_name("rebuild|refit|auto")
      ->default_str("rebuild");
}

void add_named_device(CLI::App& app, DeviceOptions& device) {
  app.add_option("--device", device.select, "part of a device's name, or its index")->type_name("NAME|INDEX");
}

void add_device(CLI::App& app, DeviceOptions& device) {
  add_named_device(app, device);
  app.add_flag("--validate", device.validate, "Vulkan validation layers on; a message is a failure");
}

void add_trace_events(CLI::App& app, std::string& file) {
  app.add_option("--trace-events", file, "write every kernel as a Chrome trace event")->type_name("FILE");
}

void add_runs(CLI::App& app, std::uint32_t& runs, const std::string& help) {
  app.add_option("--runs", runs, help)->check(CLI::Range(1u, 10000u))->capture_default_str();
}

void add_scene(CLI::App& app, SceneOptions& scene) {
  app.add_option("SCENE", scene.spec,
                 "a file (.obj, .gltf, .glb, .ply, .anim or scene file .json) or a built-in scene")
      ->capture_default_str();
}

std::vector<std::string> device_builder_names() {
  std::vector<std::string> builders;
  for (const NamedDeviceBuilder& named : device_builders()) builders.emplace_back(named.name);
  return builders;
}

std::vector<std::string> builder_names() {
  std::vector<std::string> builders;
  for (const CpuBuilder& builder : cpu_builders()) builders.emplace_back(builder.name);
  for (std::string& name : device_builder_names()) builders.push_back(std::move(name));
  return builders;
}

void add_builder(CLI::App& app, BuilderChoice& builder, const std::vector<std::string>& names) {
  app.add_option("--builder", builder.name)->check(CLI::IsMember(names))->capture_default_str();
}

void add_leaf_size(CLI::App& app, BuilderChoice& builder) {
  app.add_option("--leaf-size", builder.leaf_size,
                 "gd16-early: the most references that are not split any further")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
}

void add_lookback(CLI::App& app, DeviceChoices& choices) {
  add_words(app, "--lookback", choices.lookback, lookback_words,
            "prefix sums by decoupled lookback; auto: where the self-check allows it");
}

void add_ploc(CLI::App& app, BuilderChoice& builder, DeviceChoices& choices) {
  app.add_option("--radius", builder.radius, "search radius of PLOC and H-PLOC; other builders have none")
      ->check(CLI::Range(1u, PLOC_MAX_RADIUS))
      ->capture_default_str();
  add_words(app, "--morton-bits", builder.morton_bits, morton_words,
            "of the codes PLOC and LBVH sort by; auto: 60 where 30 leave cells crowded");
  add_lookback(app, choices);
  app.add_option(
         "--variants", choices.variants,
         "of stages that have some; auto: as tuned, or else default, which goes by the kind of device")
      ->type_name("auto|default|STAGE=VALUE,...")
      ->check([](const std::string& text) {
        Variants variants;
        return text == "auto" || text == "default" ? std::string() : set_variants(text, variants);
      })
      ->capture_default_str();
}

void add_tree(CLI::App& app, WalkChoice& walk) {
  const auto set = [&walk](const std::string& given) {
    walk = {};
    walk.said = "--tree " + given;
    walk.any_wide = given == "wide";
    for (const Walk one : {Walk::binary, Walk::wide_packets, Walk::wide_single}) {
      if (given == name_of(one)) walk.walk = one;
    }
  };
  app.add_option_function<std::string>(
         "--tree", set,
         "which the device's tracer walks; wide: eight children a node, rays in packets or each by itself, "
         "as the variant of the stage trace says or the option; auto: by that variant, but binary where the "
         "scene has more than four times as many triangles as the picture rays")
      ->check(CLI::IsMember({"auto", "binary", "wide", "wide-packets", "wide-single"}))
      ->default_str("auto");
}

void add_intersection(CLI::App& app, TraceOptions& trace) {
  add_words(app, "--triangle-test", trace.triangle_test, triangle_test_words,
            "fast: Moeller-Trumbore; watertight: Woop, Benthin and Wald");
  add_words(app, "--box-test", trace.box_test, box_test_words, "robust: slabs widened by the rounding error");
}

void add_tone(CLI::App& app, ToneMapping& tone) {
  add_words(app, "--tonemap", tone.curve, tone_curve_words,
            "what bright colours become; none: beyond 1 they are cut off");
  app.add_option("--exposure", tone.stops, "of colours, before: they are multiplied by 2 to this power")
      ->type_name("STOPS")
      ->check([](const std::string& text) {
        const std::optional<double> stops = number_of(text);
        return stops && std::abs(*stops) <= 64 ? "" : "'" + text + "' is no number between -64 and 64";
      })
      ->default_str("0");
}

void add_error(CLI::App& app, RefineLimits& refine, const std::string& help) {
  add_limit(app, "--error", refine.error, 100, help);
}

void add_refine(CLI::App& app, RefineLimits& refine) {
  add_limit(app, "--seconds", refine.seconds, 86400,
            "more and more samples, at most as many as --spp says, until so long was spent on tracing");
  add_error(app, refine,
            "the same until the picture's relative error, estimated from its samples, is no more than this");
  app.add_flag("--adaptive", refine.adaptive,
               "of --error: after 16 samples only of pixels whose own error is larger");
}

void add_effects(CLI::App& app, SceneOptions& scene) {
  const auto set = [&effects = scene.effects](const std::string& given) {
    try {
      effects = EffectChanges(given);
    } catch (const InputError& error) {
      throw CLI::ValidationError("--effects: " + std::string(error.what()));
    }
  };
  app.add_option_function<std::string>(
         "--effects", set, "effects that the picture has or has not, whatever the scene calls for")
      ->type_name("+E,-E,...");
  app.add_option("--environment", scene.environment,
                 "light from everywhere: an equirectangular HDR image (.hdr, .exr), or sky for a clear one")
      ->type_name("FILE|sky");
  app.add_option("--bounces", scene.bounces,
                 "of paths of light, where the picture has any; default what the scene says, or 4")
      ->check(CLI::Range(0u, MAX_BOUNCES));
}

void add_lens(CLI::App& app, SceneOptions& scene) {
  const auto add = [&](const char* name, std::optional<double>& value, double least, const char* help) {
    const auto set = [&value](const std::string& given) { value = number_of(given); };
    app.add_option_function<std::string>(name, set, help)
        ->type_name("LENGTH")
        ->check([least](const std::string& text) -> std::string {
          const std::optional<double> number = number_of(text);
          if (number && *number >= least && *number <= 1e30) return "";
          return "'" + text + "' is no length from " + (least > 0 ? "1e-30" : "0") + " to 1e30";
        });
  };
  add("--aperture", scene.aperture, 0, "diameter of the camera's lens, in the file's unit; 0: a pinhole");
  add("--focus", scene.focus, 1e-30, "depth at which a lens is sharp; default: what the camera looks at");
}

void add_show(CLI::App& app, ShowOptions& show) {
  const auto set = [&show](const std::string& given) {
    show.show = static_cast<Show>(std::ranges::find(SHOW_NAMES, given) - SHOW_NAMES);
  };
  app.add_option_function<std::string>(
         "--show", set,
         "the scene, or of each pixel: nodes visited, normal, depth, triangle, "
         "place in Morton order, cluster of PLOC, instance; or boxes of the tree")
      ->check(CLI::IsMember(std::vector<std::string>(std::begin(SHOW_NAMES), std::end(SHOW_NAMES))))
      ->default_str("color");
  app.add_option("--most-steps", show.most_steps,
                 "of --show steps: at the red end; default 128, through a wide tree 64")
      ->check(CLI::Range(1u, 1u << 20));
  app.add_option("--round", show.round, "of --show clusters: after so many rounds of PLOC")
      ->check(CLI::Range(0u, 1u << 20))
      ->capture_default_str();
  app.add_option("--level", show.level, "of --show boxes: those down to this level of the tree")
      ->check(CLI::Range(0u, TRACE_STACK_LIMIT))
      ->capture_default_str();
}

void add_scene_and_build(CLI::App& app, SceneOptions& scene, BuilderChoice& builder, DeviceSetup& device,
                         const std::vector<std::string>& names) {
  add_scene(app, scene);
  add_builder(app, builder, names);
  add_ploc(app, builder, device.choices);
  add_device(app, device.options);
}

}  // namespace coppice
