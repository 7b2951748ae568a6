#include "measure/frame_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/tree_hash.h"
#include "measure/effects_report.h"
#include "measure/show_frame.h"
#include "measure/table.h"
#include "render/film.h"

namespace coppice {

namespace {

// What every picture has unless effects take its place, and those that are on.
Json names_of_effects(const Scene& scene, const EffectSet& set) {
  const bool surrounded = set.is_used(Effect::environment);
  const bool replaced = scene.light_origin.empty() && (surrounded || set.is_used(Effect::emission));
  Json effects = Json::array();
  if (!surrounded) effects.push_back("ambient");
  if (scene.light.radiance != vec3(0) && !replaced) effects.push_back("directional_light");
  for (std::size_t i = 0; i < effect_count; ++i) {
    if (set.has(static_cast<Effect>(i))) effects.push_back(EFFECT_NAMES[i]);
  }
  return effects;
}

// In the coordinates of the file, as --camera takes them.
Json camera_of(const Scene& scene, const FrameRuns& frame) {
  const View view = choose_view(scene, frame.camera, frame.trace.width, frame.trace.height);
  return {{"eye", coordinates(to_file(scene, view.eye))},
          {"target", coordinates(to_file(scene, view.target))},
          {"up", coordinates(direction_to_file(scene, -view.down))},
          {"fov", view.vertical_fov_degrees}};
}

std::uint32_t samples_of(const FrameReport& report, const FrameRuns& frame) {
  return report.refined ? report.refined->samples : frame.trace.samples;
}

double mean_samples(const FrameReport& report, const FrameRuns& frame) {
  return static_cast<double>(report.rays) / frame.trace.width / frame.trace.height;
}

double mrays_per_s(const FrameReport& report) {
  const std::uint64_t rays = report.rays + report.shadow.rays + report.occlusion.rays + report.bounced.rays;
  return static_cast<double>(rays) / report.trace_ms / 1000;
}

}  // namespace

Json to_json(const FrameReport& report, const Scene& scene, const FrameRuns& frame,
             const FrameSurroundings& around) {
  Json json = {{"build", to_json(report.build)},
               {"width", frame.trace.width},
               {"height", frame.trace.height},
               {"spp", samples_of(report, frame)},
               {"tonemap", TONE_CURVE_NAMES[frame.trace.tone.curve]},
               {"exposure", frame.trace.tone.stops},
               {"offset", coordinates(scene.offset)},
               {"camera", camera_of(scene, frame)},
               {"tracer", around.tracer},
               {"trace_device", report.trace_device},
               {"tree", report.walks_wide ? "wide" : "binary"},
               {"wide_ms", report.wide_ms},
               {"trace_ms", report.trace_ms},
               {"rays",
                {{"primary", report.rays},
                 {"shadow", report.shadow.rays},
                 {"reflection", report.lobes.reflected},
                 {"refraction", report.lobes.transmitted},
                 {"occlusion", report.occlusion.rays},
                 {"diffuse", report.lobes.diffuse}}},
               {"mrays_per_s", mrays_per_s(report)},
               {"effects", names_of_effects(scene, effects_of(scene, frame.effects))},
               {"kernels", to_json(report.kernels)}};
  sums_to_json(report.kernels, json);
  if (report.refined)
    json["refined"] = {{"seconds", report.refined->seconds},
                       {"error", std::isfinite(report.refined->error) ? Json(report.refined->error) : Json()},
                       {"mean_spp", mean_samples(report, frame)},
                       {"ended_by", name_of(report.refined->ended_by)}};
  if (frame.explains) json["explained"] = to_json(effects_of(scene, frame.effects));
  json["show"] = name_of(report.shown.options.show);
  json["shown"] = to_json(report.shown, scene);
  if (report.build.instances) json["instances"] = report.build.instances;
  json["image_hash"] = hex16(image_hash(report.image));
  json["hits"] = report.hits;
  json["steps_per_ray"] =
      report.rays > 0 ? static_cast<double>(report.steps) / static_cast<double>(report.rays) : 0.0;
  return json;
}

std::string text_of(const FrameReport& report, const Scene& scene, const FrameRuns& frame,
                    const FrameSurroundings& around) {
  const BuildReport& build = report.build;
  std::string text =
      format("%s: %llu triangles", build.scene.c_str(), static_cast<unsigned long long>(build.triangles));
  if (build.inactive)
    text += format(", %llu of them inactive", static_cast<unsigned long long>(build.inactive));
  if (build.instances)
    text += format(", in %llu instances of meshes", static_cast<unsigned long long>(build.instances));
  text += format("\n  load     %9.1f ms\n", around.load_ms);
  if (around.prepare_ms > 0) text += format("  device   %9.1f ms  open, self-check\n", around.prepare_ms);
  text += format("  build    %9.1f ms  %s on %s, SAH cost %.2f, depth %u\n", build.build_ms.median,
                 build.builder.c_str(), build.device.c_str(), build.quality.sah, build.quality.depth);
  if (report.walks_wide)
    text += format("  wide     %9.1f ms  the tree with eight children a node\n", report.wide_ms);
  text += format("  trace    %9.1f ms  %ux%u, %u spp, %.2f Mrays/s on the %s\n", report.trace_ms,
                 frame.trace.width, frame.trace.height, samples_of(report, frame), mrays_per_s(report),
                 around.tracer.c_str());
  if (report.refined) {
    const Refined& refined = *report.refined;
    const std::string error = refined.samples > 1 ? format("%.3g", refined.error) : "unknown: of one sample";
    text += format("  refined  %9.1f s   relative error %s, ended by %s, %.1f spp on average\n",
                   refined.seconds, error.c_str(), name_of(refined.ended_by), mean_samples(report, frame));
  }
  if (report.shadow.rays > 0)
    text += format("  shadows  %9llu rays, %llu of them blocked\n",
                   static_cast<unsigned long long>(report.shadow.rays),
                   static_cast<unsigned long long>(report.shadow.hits));
  if (report.occlusion.rays > 0)
    text += format("  ambient  %9llu rays, %llu of them blocked\n",
                   static_cast<unsigned long long>(report.occlusion.rays),
                   static_cast<unsigned long long>(report.occlusion.hits));
  if (report.bounced.rays > 0)
    text += format("  bounces  %9llu rays, %llu of them hit\n",
                   static_cast<unsigned long long>(report.bounced.rays),
                   static_cast<unsigned long long>(report.bounced.hits));
  text += text_of(report.shown, scene);
  text += format("  write    %9.1f ms\n", around.write_ms);
  if (!report.kernels.rows.empty() && !build.kernels.rows.empty()) text += text_of(build.kernels);
  if (!report.kernels.rows.empty()) text += text_of(report.kernels);
  return text + "picture: " + around.output + "\n";
}

}  // namespace coppice
