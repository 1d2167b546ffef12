#include "shared_numbers.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <string_view>

#include "bough/blocks/at.hpp"

namespace bough::solve {

namespace {

std::size_t hash_of(const double* values, std::int64_t count) {
  const std::string_view bytes(reinterpret_cast<const char*>(values), at(count) * sizeof(double));
  return std::hash<std::string_view>{}(bytes);
}

}  // namespace

SharedNumbers::SharedNumbers(std::int64_t count, std::int64_t numbers)
    : begin_(at(count), 0), size_(at(count), 0), table_(std::bit_ceil(at(2 * count + 1)), -1) {
  values_.reserve(at(numbers));
}

void SharedNumbers::clear() {
  std::fill(table_.begin(), table_.end(), -1);
  values_.clear();
  count_ = 0;
}

double* SharedNumbers::begin(std::int64_t size, double value) {
  begin_[count_] = static_cast<std::int64_t>(values_.size());
  size_[count_] = size;
  values_.resize(values_.size() + at(size), value);
  return values_.data() + begin_[count_];
}

void SharedNumbers::end() {
  const std::int64_t first = begin_[count_], size = size_[count_];
  std::size_t slot = hash_of(values_.data() + first, size) & (table_.size() - 1);
  for (; table_[slot] >= 0; slot = (slot + 1) & (table_.size() - 1)) {
    const auto other = at(table_[slot]);
    if (size_[other] != size ||
        std::memcmp(values_.data() + begin_[other], values_.data() + first, at(size) * sizeof(double)) != 0)
      continue;
    begin_[count_] = begin_[other];
    values_.resize(at(first));
    break;
  }
  if (begin_[count_] == first) table_[slot] = static_cast<int>(count_);
  ++count_;
}

std::int64_t SharedNumbers::memory_bytes() const {
  return static_cast<std::int64_t>(values_.size() * sizeof(double) + 2 * begin_.size() * sizeof(std::int64_t) +
                                   table_.size() * sizeof(int));
}

}  // namespace bough::solve
