// A glTF file: its JSON document and its buffers, and a reading of them with its warnings.
#pragma once

#include <any>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/file_reach.h"
#include "load/node.h"
#include "scene/load_progress.h"

namespace candela::gltf {

// The part of a file that every scene of it shares: its document, its buffers, and values made from them.
// Reads .gltf (JSON) and .glb (JSON and a buffer in one file), which differ in their first bytes. A buffer is
// read when it is first needed. Places in messages are JSON pointers: `room.glb#/accessors/3/count`.
class Contents : public std::enable_shared_from_this<Contents> {
  public:
    // Throws Error if the file cannot be read, is cut off, or is not of version 2. This file and all files
    // that it names must be within `reach`.
    Contents(const std::filesystem::path& path, FileReach reach, const LoadProgress& progress);
    Contents(const Contents&) = delete;
    Contents& operator=(const Contents&) = delete;

    Node root() const { return Node(document_); }
    const std::filesystem::path& path() const { return path_; }
    const FileReach& reach() const { return reach_; }
    size_t size() const { return bytes_.size(); }
    // The buffer of a .glb.
    const std::optional<std::string_view>& chunk() const { return chunk_; }
    const std::vector<std::string>& warnings() const { return warnings_; }

    // The result of the first call of make() for this key; each key has one type.
    template <class Make>
    const auto& keep(const std::string& key, const Make& make) {
        using Value = decltype(make());
        std::any& kept = kept_[key];
        if (!kept.has_value()) kept.emplace<Value>(make());
        return *std::any_cast<Value>(&kept);
    }

  private:
    std::string_view split_glb();

    FileReach reach_;
    std::filesystem::path path_;
    std::string bytes_;  // Bytes of the file.
    std::optional<std::string_view> chunk_;
    json::Document document_;
    std::vector<std::string> warnings_;
    std::unordered_map<std::string, std::any> kept_;
};

// A reading of a file, from which a scene is made. Every reading gives the same scene.
class File {
  public:
    // Reports progress for the bytes of each buffer's file that it reads first.
    File(Contents& contents, LoadProgress progress);
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    Contents& contents() const { return contents_; }
    Node root() const { return contents_.root(); }
    const std::filesystem::path& path() const { return contents_.path(); }
    // The file that a relative URI names, as file_of() finds it.
    std::filesystem::path named(const Node& uri) const;
    // Its first `max` bytes, or all. Throws Error at the place of `uri` if it cannot be read.
    std::string read_named(const Node& uri, uint64_t max = UINT64_MAX) const;

    // How many elements a top-level array has, such as "meshes"; 0 if it is missing.
    size_t count(std::string_view array) const;
    // Its element `i`, which is below count().
    Node element(std::string_view array, size_t i) const;
    // The index that `reference` holds into a top-level array. Throws Error if it has no such element.
    uint32_t index(std::string_view array, const Node& reference) const;
    // The element that `reference` refers to.
    Node resolve(std::string_view array, const Node& reference) const {
        return element(array, index(array, reference));
    }

    // The bytes of a bufferView, decoded if they are compressed; valid as long as the contents. Throws Error
    // if they are missing or damaged.
    std::span<const std::byte> view_bytes(const Node& view);

    // The index in Scene::images of the file's image `i`, once it has one.
    std::optional<uint32_t>& image_index(uint32_t i) { return images_[i]; }

    // How many bytes this reading has used so far: the file, the buffers, and what was decoded of them.
    size_t bytes_read() const { return contents_.size() + buffer_bytes_read_; }
    // Counts bytes that were decoded at a place, the first time.
    void count_decoded(const std::string& place, size_t bytes) {
        if (decoded_.insert(place).second) buffer_bytes_read_ += bytes;
    }

    // Files besides this one that were read for buffers.
    const std::vector<std::filesystem::path>& files() const { return files_; }

    // Notes what is odd but usable, each text once.
    void warn(const Node& place, const std::string& text) { warn(place.place() + ": " + text); }
    void warn(const std::string& text);
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    std::span<const std::byte> buffer_bytes(uint32_t index);
    std::span<const std::byte> plain_bytes(const Node& view);
    std::string_view named_buffer(uint32_t index, const Node& uri, size_t length);

    Contents& contents_;
    LoadProgress progress_;
    std::vector<bool> is_read_;  // For each buffer.
    size_t buffer_bytes_read_ = 0;
    std::unordered_set<std::string> decoded_;  // Places.
    std::vector<std::optional<uint32_t>> images_;
    std::vector<std::filesystem::path> files_;
    std::vector<std::string> warnings_;
    std::unordered_set<std::string> warned_;  // The same, for lookup.
};

}  // namespace candela::gltf
