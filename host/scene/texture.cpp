#include "scene/texture.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "scene/input_error.h"
#include "scene/material_maps.h"
#include "scene/obj_file.h"
#include "scene/obj_mtl_files.h"
#include "scene/printable.h"

namespace coppice {
namespace {

static_assert(MATERIAL_MAPS[0].map == &Material::diffuse_map);
static_assert(MATERIAL_MAPS.size() == std::tuple_size_v<decltype(TextureListing::of_material)::value_type>);

class TextureLister {
 public:
  explicit TextureLister(const Scene& scene) : scene_(scene), is_used_(scene.materials.size()) {
    for (const std::uint32_t material : scene.material_index) is_used_[material] = true;
  }

  TextureListing list() {
    std::array<std::uint32_t, MATERIAL_MAPS.size()> none;
    none.fill(TextureListing::NONE);
    listing_.of_material.assign(scene_.materials.size(), none);
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
      for (std::size_t k = 0; is_used_[m] && k < MATERIAL_MAPS.size(); ++k) {
        const TextureMap& map = scene_.materials[m].*MATERIAL_MAPS[k].map;
        if (map) listing_.of_material[m][k] = use_of(map, scene_.materials[m], MATERIAL_MAPS[k]);
      }
    }
    return std::move(listing_);
  }

 private:
  // Alpha is the same in images of colours and of numbers.
  std::uint32_t use_of(const TextureMap& map, const Material& material, const MaterialMap& kind) {
    const bool is_colour = kind.is_colour || map.channel == 'm';
    const std::uint32_t image = image_of(map, is_colour, material, kind);
    const auto key =
        std::tuple(image, map.wrap_u, map.wrap_v, map.scale.x, map.scale.y, map.offset.x, map.offset.y);
    const auto [known, is_new] = uses_.try_emplace(key, static_cast<std::uint32_t>(listing_.uses.size()));
    if (is_new) listing_.uses.push_back({map, is_colour, image});
    return known->second;
  }

  std::uint32_t image_of(const TextureMap& map, bool is_colour, const Material& material,
                         const MaterialMap& kind) {
    const auto key = std::tuple(map.folder, map.name, map.bytes.get(), is_colour);
    const auto [known, is_new] = images_.try_emplace(key, static_cast<std::uint32_t>(listing_.images.size()));
    if (is_new) {
      listing_.images.push_back(
          {map.name, map.folder, map.bytes, is_colour,
           std::string(kind.name) + " of material '" + printable(std::string_view(material.name)) + "'"});
    }
    return known->second;
  }

  const Scene& scene_;
  std::vector<bool> is_used_;
  TextureListing listing_;
  std::map<std::tuple<std::uint32_t, TextureWrap, TextureWrap, float, float, float, float>, std::uint32_t>
      uses_;
  std::map<std::tuple<std::string, std::string, const std::string*, bool>, std::uint32_t> images_;
};

// Throws InputError where there is none.
template <class Use>
auto with_bytes(const TextureListing::Image& image, const Use& use) {
  if (image.bytes) {
    if (image.bytes->empty()) throw InputError("no bytes of an image that is read");
    return use(std::string_view(*image.bytes));
  }
  const auto found = MtlFolder(image.folder).locate(image.name);
  if (!found) throw InputError("no such file");
  const ObjFile file = read_obj_file(*found);
  return use(file.text());
}

Texture decoded(const TextureListing::Image& image) {
  return with_bytes(image, [&](std::string_view bytes) { return decode_texture(bytes, image.is_colour); });
}

bool is_cut_out(const Texture& texture) {
  std::size_t holes = 0, solid = 0;
  const std::vector<std::uint32_t>& texels = texture.levels.front().texels;
  for (const std::uint32_t texel : texels) {
    holes += texel >> 24 < 16;
    solid += texel >> 24 >= 240;
  }
  return std::min(holes, solid) * 100 >= texels.size() && (holes + solid) * 4 >= texels.size() * 3;
}

// Not of one that is missing or broken, about which whoever takes its colours says so.
bool is_cut_out(const TextureListing::Image& image) {
  try {
    return with_bytes(image, [&](std::string_view bytes) {
      return has_alpha_channel(bytes) && is_cut_out(decode_texture(bytes, image.is_colour));
    });
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

TextureListing list_textures(const Scene& scene) { return TextureLister(scene).list(); }

Texture load_texture(const TextureListing::Image& image, std::string& warning) {
  const std::filesystem::path path = std::filesystem::path(image.folder) / image.name;
  const std::string place = image.bytes ? printable(std::string_view(image.name)) : printable(path);
  try {
    return decoded(image);
  } catch (const InputError& error) {
    const std::string what = error.what();
    warning =
        (what.starts_with(place) ? "" : place + ": ") + what + ", a checker takes its place as " + image.user;
  } catch (const std::bad_alloc&) {
    warning = place + ": no memory for the image, a checker takes its place as " + image.user;
  }
  return checker_texture(image.is_colour);
}

void find_cut_outs(Scene& scene) {
  const TextureListing listing = list_textures(scene);
  const auto may_cut_out = [&](std::size_t m) {
    const Material& material = scene.materials[m];
    return material.diffuse_map.may_cut_out && !material.opacity_map &&
           listing.of_material[m][0] != TextureListing::NONE;
  };
  const auto image_of = [&](std::size_t m) { return listing.uses[listing.of_material[m][0]].image; };
  std::map<std::uint32_t, bool> cuts;  // by image
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (may_cut_out(m)) cuts.emplace(image_of(m), false);
  }
  tbb::parallel_for_each(cuts.begin(), cuts.end(),
                         [&](auto& cut) { cut.second = is_cut_out(listing.images[cut.first]); });
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (!may_cut_out(m) || !cuts.at(image_of(m))) continue;
    scene.materials[m].opacity_map = scene.materials[m].diffuse_map;
    scene.materials[m].opacity_map.channel = 'm';
  }
}

}  // namespace coppice
