#pragma once
/// What changes as a run goes, as bytes: written by one function of each owner, and read by the same one.
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

namespace bough::records {

/// Writes fields into bytes, or reads them back, in the order in which they are named:
///   void checkpoint(records::Archive& archive) { archive(time_, counts_, watch_); }
/// Fields are numbers and what can be copied as bytes (no pointers), strings, lists, maps and optional ones of fields,
/// and objects that have such a function themselves. An object that is read has to be one that is made as the written
/// one was, of the same scene by the same program: what does not change is no field. The bytes have no names and no
/// types, so that only the program that wrote them may read them. Reading throws std::runtime_error where bytes end too
/// early, or more are left than were asked for.
class Archive {
 public:
  Archive() = default;  ///< writes
  /// Reads these bytes, which must outlive the archive.
  explicit Archive(std::string_view bytes) : left_(bytes), is_reading_(true) {}

  bool is_reading() const { return is_reading_; }
  const std::string& bytes() const { return bytes_; }
  std::string_view rest() const { return left_; }  ///< bytes that were not read
  void require_end() const {
    if (!left_.empty()) throw std::runtime_error("it holds more than the run has");
  }

  template <class... Fields>
  void operator()(Fields&... fields) {
    (field(fields), ...);
  }

  /// Whether an object is there that may have to be made: make() is called where one is read.
  template <class Object, class Make>
  void present(std::optional<Object>& object, const Make& make) {
    bool is_there = object.has_value();
    field(is_there);
    if (is_reading_ && !is_there) object.reset();
    if (is_reading_ && is_there && !object) make();
    if (is_there) field(*object);
  }

 private:
  void raw(void* data, std::size_t count) {
    if (!is_reading_) {
      bytes_.append(static_cast<const char*>(data), count);
      return;
    }
    if (left_.size() < count) throw std::runtime_error("it ends too early");
    if (count > 0) std::memcpy(data, left_.data(), count);
    left_.remove_prefix(count);
  }
  /// The number of elements of a list, each of which takes a byte at least.
  std::size_t size_of_list(std::size_t size) {
    auto count = static_cast<std::uint64_t>(size);
    raw(&count, sizeof count);
    if (is_reading_ && count > left_.size()) throw std::runtime_error("it ends too early");
    return static_cast<std::size_t>(count);
  }

  template <class T>
  static constexpr bool is_object = requires(T& object, Archive& archive) {
    object.checkpoint(archive);
  };

  template <class T>
  void field(T& x) {
    if constexpr (is_object<T>) {
      x.checkpoint(*this);
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>,
                    "a type whose fields are not known: give it a function checkpoint");
      raw(&x, sizeof x);
    }
  }
  void field(std::string& text) {
    text.resize(size_of_list(text.size()));
    raw(text.data(), text.size());
  }
  template <class T>
  void field(std::vector<T>& list) {
    const std::size_t count = size_of_list(list.size());
    if constexpr (!is_object<T> && std::is_trivially_copyable_v<T>) {
      if (is_reading_ && left_.size() / sizeof(T) < count) throw std::runtime_error("it ends too early");
      list.resize(count);
      raw(list.data(), count * sizeof(T));
    } else {
      if (is_reading_ && list.size() != count) list.resize(count);
      for (T& x : list) field(x);
    }
  }
  template <class T, std::size_t N>
  void field(std::array<T, N>& list) {
    for (T& x : list) field(x);
  }
  template <class T>
  void field(std::optional<T>& x) {
    present(x, [&] {
      if constexpr (std::is_default_constructible_v<T>)
        x.emplace();
      else
        throw std::runtime_error("it holds what the run does not have");
    });
  }
  template <class... T>
  void field(std::variant<T...>& x) {
    std::size_t index = x.index();
    field(index);
    if (index >= sizeof...(T)) throw std::runtime_error("it holds a kind that is not known");
    if (is_reading_ && index != x.index()) {
      std::size_t k = 0;
      ((k++ == index ? static_cast<void>(x.template emplace<T>()) : void()), ...);
    }
    std::visit([this](auto& kind) { this->field(kind); }, x);
  }
  template <class A, class B>
  void field(std::pair<A, B>& x) {
    (*this)(x.first, x.second);
  }
  template <class Key, class T>
  void field(std::map<Key, T>& map) {
    take_map(map);
  }
  template <class Key, class T>
  void field(std::unordered_map<Key, T>& map) {
    take_map(map);
  }
  template <class Map>
  void take_map(Map& map) {
    const std::size_t count = size_of_list(map.size());
    if (!is_reading_) {
      for (auto& [key, value] : map) {
        auto copy = key;
        (*this)(copy, value);
      }
      return;
    }
    map.clear();
    for (std::size_t k = 0; k < count; ++k) {
      typename Map::key_type key;
      field(key);
      field(map[key]);
    }
  }

  std::string bytes_;
  std::string_view left_;
  bool is_reading_ = false;
};

}  // namespace bough::records
