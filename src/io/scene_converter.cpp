#include "scene_converter.hpp"

#include "document_report.hpp"

namespace bough::io {

std::string SceneConverter::slice(const Value& v) const {
  return v.source == source_file ? std::string(text_.substr(v.offset, v.length)) : std::string();
}

std::optional<std::filesystem::path> SceneConverter::read_scene_file(const Value& root, std::string& text,
                                                                     std::string& name) {
  const Value* path = root.find("scene");
  if (path == nullptr || !path->sound) return std::nullopt;
  Problem problem;
  std::filesystem::path file = path_of(path->text.str());
  text = read_whole_file(file, problem);
  name = name_of_file(file);
  if (!problem.rule.empty()) {
    fault("/scene", problem.rule, "names are relative to the folder of this file: " + shown(file.string(), 200));
    return std::nullopt;
  }
  scene_.emplace(text, name, file.parent_path());
  return file;
}

std::vector<std::string> SceneConverter::read_setting(const std::string& pointer, const std::string& value,
                                                      const std::string& pointer_at) {
  std::vector<std::string> list = scene_->expand(pointer, value);
  if (list.empty())
    fault(pointer_at, "nothing in the scene is meant by this pointer", "* stands for every item of a list");
  return list;
}

}  // namespace bough::io
