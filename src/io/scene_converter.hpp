#pragma once
/// What studies and sweeps share: files that name a scene and change values in it.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "read_values.hpp"
#include "study_scene.hpp"

namespace bough::io {

class SceneConverter : protected ValueConverter {
 public:
  using ValueConverter::faults;
  using ValueConverter::warnings;

 protected:
  /// text: of the file, from which values are copied as they are written. folder: names of files are relative to it.
  SceneConverter(std::string_view text, std::filesystem::path folder) : text_(text), folder_(std::move(folder)) {}

  /// A value as it is written.
  std::string slice(const Value& v) const;
  std::filesystem::path path_of(const std::string& name) const { return (folder_.empty() ? "." : folder_) / name; }

  /// Reads the file that the key "scene" names; returns its path, or nothing where it cannot be read, which is told.
  std::optional<std::filesystem::path> read_scene_file(const Value& root, std::string& text, std::string& name);

  /// "/pointer=value" for all that a pointer names in the scene. pointer_at: where the file says it.
  std::vector<std::string> read_setting(const std::string& pointer, const std::string& value,
                                        const std::string& pointer_at);

  std::optional<StudyScene> scene_;     ///< there once it is read
  std::vector<SettingOrigin> origins_;  ///< of what all runs change

 private:
  std::string_view text_;
  std::filesystem::path folder_;
};

}  // namespace bough::io
