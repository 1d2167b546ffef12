#pragma once
/// Common part of the readers of studies and sweeps, whose files name a scene and change values in it.
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
  /// text: the text of the file, from which values are copied. folder: names of files are relative to it.
  SceneConverter(std::string_view text, std::filesystem::path folder) : text_(text), folder_(std::move(folder)) {}

  /// The text of a value in the file.
  std::string slice(const Value& v) const;
  std::filesystem::path path_of(const std::string& name) const { return (folder_.empty() ? "." : folder_) / name; }

  /// Reads the file that the key "scene" names. Returns its path, or nothing if it cannot be read, which is a fault.
  std::optional<std::filesystem::path> read_scene_file(const Value& root, std::string& text, std::string& name);

  /// Overrides "/pointer=value" for all values that a pointer names in the scene. pointer_at: place of the pointer in
  /// the file.
  std::vector<std::string> read_setting(const std::string& pointer, const std::string& value,
                                        const std::string& pointer_at);

  std::optional<StudyScene> scene_;     ///< empty until it is read
  std::vector<SettingOrigin> origins_;  ///< of the settings common to all runs

 private:
  std::string_view text_;
  std::filesystem::path folder_;
};

}  // namespace bough::io
