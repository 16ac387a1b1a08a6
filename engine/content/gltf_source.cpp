#include "engine/content/gltf_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/content/file_text.hpp"
#include "engine/content/limit_errors.hpp"

namespace fascicle::detail {
namespace {

constexpr std::size_t kMaxElements = std::size_t{1} << 25;  // 32 million, some hundreds of megabytes
constexpr std::size_t kMaxErrors = 100;
constexpr std::uint32_t kGlbMagic = 0x46546c67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void append_u32(std::vector<std::uint8_t>& bytes, std::uint64_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

struct Chunks {
  std::string_view json;
  std::span<const std::uint8_t> bin;
};

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The chunks of a .glb, whose first four bytes have been checked.
bool split_glb(GltfSource& source, std::span<const std::uint8_t> bytes, Chunks& out) {
  const auto fail = [&](std::string cause, std::string remedy) {
    source.error("", std::move(cause), std::move(remedy));
    return false;
  };
  constexpr std::string_view kIncomplete = "is the file complete?";
  if (bytes.size() < 20)
    return fail(fmt::format("a .glb of {} bytes has no room for its header", bytes.size()), std::string(kIncomplete));
  if (const std::uint32_t version = read_u32(bytes, 4); version != 2)
    return fail(fmt::format("glb version {}", version), "export as glTF 2.0");
  const std::uint32_t length = read_u32(bytes, 8);
  if (length > bytes.size())
    return fail(fmt::format("the header promises {} bytes, the file has {}", length, bytes.size()),
                std::string(kIncomplete));
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::uint32_t size = read_u32(bytes, at);
    const std::uint32_t kind = read_u32(bytes, at + 4);
    if (size > length - at - 8)
      return fail(fmt::format("a chunk of {} bytes at byte {} reaches beyond the file's {}", size, at, length),
                  std::string(kIncomplete));
    const std::span<const std::uint8_t> chunk = bytes.subspan(at + 8, size);
    if (at == 12 && kind != kJsonChunk) return fail("the first chunk is not JSON", "export it again");
    if (at == 12) out.json = as_text(chunk);
    if (kind == kBinChunk && out.bin.empty()) out.bin = chunk;  // chunks of other kinds are to be passed over
    at += 8 + std::size_t{size};
  }
  if (out.json.empty()) return fail("no JSON chunk", std::string(kIncomplete));
  return true;
}

std::string decode_percent(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t k) {
      const char c = k < uri.size() ? uri[k] : '\0';
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
      text += static_cast<char>(digit(i + 1) * 16 + digit(i + 2));
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

// Says what tinygltf would only call a failure: where each buffer's bytes are to come from, and whether there are as
// many as promised.
void check_buffers(GltfSource& source, std::size_t bin_size, bool is_glb, const std::filesystem::path& base_folder) {
  for (const JsonNode buffer : source.document->root().member("buffers")) {
    const std::string path = buffer.path();
    double length = 0.0;
    std::string uri;
    Diagnostics ignored;  // the shape is checked
    buffer.member("byteLength").read(length, ignored);
    const bool has_uri = buffer.member("uri").read(uri, ignored) && !uri.empty();
    const auto bytes = static_cast<std::uint64_t>(length);
    std::uint64_t found = 0;
    if (!has_uri) {
      if (!is_glb) {
        source.error(path, "no uri", "name the buffer's file, or embed it as a data URI");
      } else if (bytes > bin_size) {
        source.error(path, fmt::format("byteLength is {}, but the BIN chunk has {} bytes", bytes, bin_size),
                     "is the file complete?");
      }
      continue;
    }
    if (uri.starts_with("data:")) {
      constexpr std::string_view kBase64 = ";base64,";
      const std::size_t comma = uri.find(kBase64);
      const std::string_view kind = std::string_view(uri).substr(0, std::min(comma, std::size_t{64}));
      if (comma == std::string::npos ||
          (kind != "data:application/octet-stream" && kind != "data:application/gltf-buffer")) {
        source.error(path + "/uri", fmt::format("a data URI that starts with '{}'", kind),
                     "write data:application/octet-stream;base64,...");
        continue;
      }
      std::string_view code = std::string_view(uri).substr(comma + kBase64.size());
      const std::size_t bad =
          code.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=");
      if (bad != std::string_view::npos ||
          code.find_first_not_of('=', std::min(code.find('='), code.size())) != std::string_view::npos) {
        source.error(path + "/uri", "characters in the data URI that are not base64", "embed it again");
        continue;
      }
      while (code.ends_with('=')) code.remove_suffix(1);
      found = code.size() * 3 / 4;
    } else {
      if (base_folder.empty()) {
        source.error(path + "/uri", fmt::format("the buffer is in a file of its own, '{}'", uri), "embed it");
        continue;
      }
      const std::filesystem::path file = base_folder / decode_percent(uri);
      std::error_code code;
      found = std::filesystem::file_size(file, code);
      if (code) {
        source.error(path + "/uri", fmt::format("no file {}", file.string()), "put it beside the .gltf, or embed it");
        continue;
      }
    }
    if (found != bytes)
      source.error(path, fmt::format("byteLength is {}, but there are {} bytes", bytes, found),
                   "correct byteLength; is the buffer complete?");
  }
}

// The sections that tinygltf is to read; it sees nothing else, so that nothing else can trouble it.
std::string reduced_json(const JsonDocument& document) {
  std::string json = R"({"asset":{"version":"2.0"})";
  for (const char* name : {"buffers", "bufferViews", "accessors", "meshes", "nodes", "skins", "animations"}) {
    if (const JsonNode section = document.root().member(name); section.exists())
      json += fmt::format(",\"{}\":{}", name, section.text());
  }
  return json + '}';
}

std::vector<std::uint8_t> assemble_glb(std::string json, std::span<const std::uint8_t> bin) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t bin_size = (bin.size() + 3) / 4 * 4;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(28 + json.size() + bin_size);
  append_u32(bytes, kGlbMagic);
  append_u32(bytes, 2);
  append_u32(bytes, 20 + json.size() + (bin.empty() ? 0 : 8 + bin_size));
  append_u32(bytes, json.size());
  append_u32(bytes, kJsonChunk);
  bytes.insert(bytes.end(), json.begin(), json.end());
  if (bin.empty()) return bytes;
  append_u32(bytes, bin_size);
  append_u32(bytes, kBinChunk);
  bytes.insert(bytes.end(), bin.begin(), bin.end());
  bytes.resize(bytes.size() + bin_size - bin.size());
  return bytes;
}

// tinygltf also looks into the working directory; a buffer there is none of the file's.
bool file_exists(const std::string& file, void* folder) {
  const std::filesystem::path& base = *static_cast<const std::filesystem::path*>(folder);
  return !base.empty() && file.starts_with(base.string()) && tinygltf::FileExists(file, nullptr);
}

bool refuse_to_write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

bool ignore_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

void decode(GltfSource& source, const Chunks& chunks, bool is_glb, std::filesystem::path base_folder) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(ignore_image, nullptr);
  loader.SetFsCallbacks(
      {file_exists, tinygltf::ExpandFilePath, tinygltf::ReadWholeFile, refuse_to_write, &base_folder});
  const std::string json = reduced_json(*source.document);
  std::string errors, warnings;
  bool ok = false;
  if (is_glb) {
    const std::vector<std::uint8_t> glb = assemble_glb(json, chunks.bin);
    ok = loader.LoadBinaryFromMemory(&source.model, &errors, &warnings, glb.data(), static_cast<unsigned>(glb.size()),
                                     base_folder.string());
  } else {
    ok = loader.LoadASCIIFromString(&source.model, &errors, &warnings, json.data(), static_cast<unsigned>(json.size()),
                                    base_folder.string());
  }
  if (ok) return;
  errors.resize(std::min(errors.size(), std::size_t{200}));
  std::ranges::replace(errors, '\n', ' ');
  source.error("", errors.empty() ? "tinygltf cannot read it" : errors, "check it with a glTF validator");
}

}  // namespace

Diagnostic GltfSource::make(std::string path, std::string cause, std::string remedy) const {
  Diagnostic diagnostic{file, 0, 0, std::move(path), std::move(cause), std::move(remedy)};
  if (has_positions && document) {
    const JsonNode node = document->nearest(diagnostic.path);
    diagnostic.line = node.line();
    diagnostic.column = node.column();
  }
  return diagnostic;
}

void GltfSource::error(std::string path, std::string cause, std::string remedy) {
  if (has_room(diagnostics.errors, kMaxErrors, file))
    diagnostics.errors.push_back(make(std::move(path), std::move(cause), std::move(remedy)));
}

void GltfSource::warning(std::string path, std::string cause, std::string remedy) {
  if (has_room(diagnostics.warnings, kMaxErrors, file))
    diagnostics.warnings.push_back(make(std::move(path), std::move(cause), std::move(remedy)));
}

bool GltfSource::spend(std::size_t elements, const std::string& path) {
  if (elements <= kMaxElements - spent_) {
    spent_ += elements;
    return true;
  }
  error(path, fmt::format("more than {} elements in all", kMaxElements), "split the file; is the count right?");
  return false;
}

void load_gltf_model(GltfSource& source, std::span<const std::uint8_t> bytes,
                     const std::filesystem::path& base_folder) {
  if (bytes.size() >= 0xf0000000u) return source.error("", "larger than 3.75 GiB", "split the file");
  const bool is_glb = bytes.size() >= 4 && read_u32(bytes, 0) == kGlbMagic;
  Chunks chunks{as_text(bytes), {}};
  if (is_glb && !split_glb(source, bytes, chunks)) return;
  source.has_positions = !is_glb;

  Result<JsonDocument> document = parse_json(std::string(chunks.json), source.file);
  if (!document) {
    Diagnostics& found = document.diagnostics();
    for (Diagnostic& diagnostic : found.errors) {
      if (is_glb) diagnostic.line = diagnostic.column = 0;
    }
    return source.diagnostics.append(std::move(found));
  }
  source.document = std::move(*document);
  check_gltf_shape(source);
  if (source.ok()) check_buffers(source, chunks.bin.size(), is_glb, base_folder);
  if (source.ok()) decode(source, chunks, is_glb, base_folder);
}

std::string UniqueNames::take(const std::string& name, const std::string& fallback) {
  const std::string& base = name.empty() ? fallback : name;
  const auto [entry, is_new] = uses_.try_emplace(base, 1);
  if (is_new) return base;
  for (;;) {
    std::string numbered = fmt::format("{}_{}", base, ++entry->second);
    if (uses_.try_emplace(numbered, 1).second) return numbered;
  }
}

}  // namespace fascicle::detail
