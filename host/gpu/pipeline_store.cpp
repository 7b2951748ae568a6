#include "gpu/pipeline_store.h"

#include <unistd.h>

#include <cstring>
#include <fstream>

#include "gpu/kept_file.h"

namespace coppice {

namespace {

namespace fs = std::filesystem;

// In front of what the driver gave: some drivers do not survive a blob that is cut or altered.
struct FileHeader {
  char magic[8] = {'c', 'o', 'p', 'p', 'i', 'c', 'e', '1'};
  std::uint64_t bytes = 0, hash = 0;
};

std::uint64_t fnv1a(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  return hash;
}

FileHeader header_of(const std::vector<std::uint8_t>& blob) {
  FileHeader header;
  header.bytes = blob.size();
  header.hash = fnv1a(blob);
  return header;
}

template <class Uuid>
std::string hexadecimal(const Uuid& uuid) {
  std::string text;
  for (const std::uint8_t byte : uuid) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

// Whether the driver that runs made the blob, by the header that Vulkan prescribes.
bool is_of_this_driver(const std::vector<std::uint8_t>& blob, const vk::PhysicalDeviceProperties& device) {
  VkPipelineCacheHeaderVersionOne header;
  if (blob.size() < sizeof header) return false;
  std::memcpy(&header, blob.data(), sizeof header);
  return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == device.vendorID &&
         header.deviceID == device.deviceID &&
         std::memcmp(header.pipelineCacheUUID, device.pipelineCacheUUID.data(), VK_UUID_SIZE) == 0;
}

// Far above what drivers keep of some dozens of kernels.
constexpr std::uint64_t most_kept_bytes = std::uint64_t{256} << 20;

// Empty for none.
std::vector<std::uint8_t> read_blob(const fs::path& path, const vk::PhysicalDeviceProperties& device) {
  const std::string bytes = read_kept_file(path, most_kept_bytes).bytes;
  if (bytes.size() < sizeof(FileHeader)) return {};
  const std::vector<std::uint8_t> blob(bytes.begin() + sizeof(FileHeader), bytes.end());
  const FileHeader expected = header_of(blob);
  const bool whole = std::memcmp(bytes.data(), &expected, sizeof expected) == 0;
  return whole && is_of_this_driver(blob, device) ? blob : std::vector<std::uint8_t>();
}

void write_blob(const fs::path& path, const std::vector<std::uint8_t>& blob) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  const fs::path partial = path.string() + "." + std::to_string(getpid());
  const FileHeader header = header_of(blob);
  std::ofstream file(partial, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&header), sizeof header);
  file.write(reinterpret_cast<const char*>(blob.data()), static_cast<std::streamsize>(blob.size()));
  file.close();
  if (file) fs::rename(partial, path, error);
  if (!file || error) fs::remove(partial, error);
}

}  // namespace

std::string file_name_of(std::string_view stem, const vk::raii::PhysicalDevice& physical) {
  const auto properties =
      physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties>();
  const auto& id = properties.get<vk::PhysicalDeviceIDProperties>();
  return std::string(stem) + "-" + hexadecimal(id.deviceUUID) + "-" + hexadecimal(id.driverUUID);
}

void load_pipelines(VulkanContext& context, const fs::path& folder) {
  if (folder.empty()) return;
  context.pipeline_file = folder / file_name_of("pipelines", context.physical);
  if (context.adopted_cache) return;
  context.kept_pipelines = read_blob(context.pipeline_file, context.physical.getProperties());
  const std::vector<std::uint8_t>& blob = context.kept_pipelines;
  context.pipeline_cache =
      vk::raii::PipelineCache(context.device, {{}, blob.size(), blob.data()}, context.allocator);
}

void store_pipelines(const VulkanContext& context) noexcept {
  if (context.adopted_cache || !*context.pipeline_cache || context.pipelines.empty()) return;
  try {
    const std::vector<std::uint8_t> blob = context.pipeline_cache.getData();
    if (blob != context.kept_pipelines) write_blob(context.pipeline_file, blob);
  } catch (const std::exception&) {  // then the next run compiles again
  }
}

}  // namespace coppice
