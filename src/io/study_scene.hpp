#pragma once
/// The scene of a study while the study is read: the values that settings refer to, and the settings that cause faults
/// of the scene.
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"
#include "read_values.hpp"

namespace bough::io {

/// A value of the scene and the place in the study's file that sets it.
struct SettingOrigin {
  std::string scene_pointer, spec_pointer;
};

class StudyScene {
 public:
  /// folder: that of the files that the scene names; empty: it may not name files.
  StudyScene(std::string text, std::string name, std::filesystem::path folder = {})
      : text_(std::move(text)), name_(std::move(name)), folder_(std::move(folder)) {}

  const std::string& text() const { return text_; }

  /// Overrides "/pointer=value" with every `*` replaced by the indices of its list; empty if there is no such list.
  std::vector<std::string> expand(const std::string& pointer, const std::string& value);

  /// Reads the scene with overrides. Each problem becomes one fault, at the setting that contains the problem's place,
  /// else at `otherwise`. A fault that was reported for the same place before is not repeated.
  std::optional<scene::Scene> read(const std::vector<std::string>& overrides, const std::vector<SettingOrigin>& origins,
                                   const std::string& otherwise, PlacedFaults& faults);
  /// Number of problems of the scene with overrides.
  std::size_t num_problems(const std::vector<std::string>& overrides) const {
    return read_scene_text(text_, name_, overrides, folder_).problems.size();
  }

 private:
  void expand_tokens(const JsonValue* at, const std::vector<std::string>& tokens, std::size_t k, std::string so_far,
                     std::vector<std::string>& pointers) const;

  std::string text_, name_;
  std::filesystem::path folder_;
  std::optional<JsonValue> root_;
  std::set<std::string> said_;
};

}  // namespace bough::io
