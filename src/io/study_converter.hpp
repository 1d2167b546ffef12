#pragma once
/// Turns a checked document into a study.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/read_study.hpp"
#include "bough/scene/nearest_name.hpp"
#include "read_values.hpp"
#include "study_scene.hpp"

namespace bough::io {

inline std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = scene::nearest_name(word, known);
  return near.empty() ? "" : "did you mean \"" + near + "\"?";
}

class StudyConverter : private ValueConverter {
 public:
  using ValueConverter::faults;
  using ValueConverter::warnings;
  StudySpec spec;

  /// text: of the study, from which values are copied as they are written. folder: names of files are relative to it.
  StudyConverter(std::string_view text, std::filesystem::path folder) : text_(text), folder_(std::move(folder)) {}

  void convert(const JsonValue& root);

 private:
  static const Value* sound(const Value& object, const char* key) {
    const Value* v = object.find(key);
    return v != nullptr && v->sound ? v : nullptr;
  }

  // The scene (read_study.cpp).
  std::string slice(const Value& v) const;
  bool read_scene_file(const Value& root);
  void read_base(const Value& root);
  std::vector<std::string> read_setting(const std::string& pointer, const Value& value, const std::string& pointer_at);
  std::vector<std::string> read_settings(const Value& list, const std::string& at);
  static void add_origins(const std::vector<std::string>& overrides, const std::string& at,
                          std::vector<SettingOrigin>& origins);

  // What is compared (read_study_quantities.cpp).
  void read_quantity(const Value& v, const std::string& at);
  bool find_columns(const Value& v, const std::string& at, StudyQuantity& q);
  void read_formula(const Value& v, const std::string& at, StudyQuantity& q);
  void read_table(const Value& v, const std::string& at, StudyQuantity& q);

  // What is varied (read_study_grids.cpp).
  StudyReference read_reference(const Value& v, const std::string& at);
  void read_grid(const Value& v, const std::string& at);
  StudyAxis read_axis(const Value& v, const std::string& at);
  std::optional<StudyChoice> read_value(const std::string& name, const std::string& pointer, const Value& v,
                                        const std::string& at, const std::string& pointer_at);
  void read_orders(const Value& list, const std::string& at, StudyGrid& grid);
  void check_runs(const StudyGrid& grid, const std::string& at);
  bool check_samples(const scene::Scene& scene, const std::string& at);

  std::string_view text_;
  std::filesystem::path folder_;
  std::optional<StudyScene> scene_;
  std::optional<scene::Scene> base_;    ///< the scene with what all runs change
  std::vector<SettingOrigin> origins_;  ///< of what all runs change
  std::vector<std::string> columns_;    ///< of its history
};

}  // namespace bough::io
