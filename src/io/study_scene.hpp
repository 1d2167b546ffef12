#pragma once
/// The scene of a study while the study is read: where its settings lead, and who is to blame for what is wrong with
/// it.
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"
#include "read_values.hpp"

namespace bough::io {

/// Where a value of the scene comes from in the study's file.
struct SettingOrigin {
  std::string scene_pointer, spec_pointer;
};

class StudyScene {
 public:
  /// folder: of files that the scene names; empty: it may name none.
  StudyScene(std::string text, std::string name, std::filesystem::path folder = {})
      : text_(std::move(text)), name_(std::move(name)), folder_(std::move(folder)) {}

  const std::string& text() const { return text_; }

  /// "/pointer=value" with every `*` replaced by the indices of the list it stands in; nothing where there is no such
  /// list.
  std::vector<std::string> expand(const std::string& pointer, const std::string& value);

  /// Reads the scene with overrides. Each problem becomes one fault, at the setting that the problem's place belongs
  /// to, else at `otherwise`; what was said of a place before is not said again.
  std::optional<scene::Scene> read(const std::vector<std::string>& overrides, const std::vector<SettingOrigin>& origins,
                                   const std::string& otherwise, PlacedFaults& faults);

 private:
  void expand_tokens(const JsonValue* at, const std::vector<std::string>& tokens, std::size_t k, std::string so_far,
                     std::vector<std::string>& pointers) const;

  std::string text_, name_;
  std::filesystem::path folder_;
  std::optional<JsonValue> root_;
  std::set<std::string> said_;
};

}  // namespace bough::io
