#include "bough/io/shared_text.hpp"

#include <sys/mman.h>

#include <atomic>
#include <cstring>
#include <new>
#include <utility>

namespace bough::io {

struct SharedText::Shared {
  std::atomic<std::size_t> size{0};  ///< [bytes] completely appended
  [[nodiscard]] char* begin() { return reinterpret_cast<char*>(this + 1); }
};

SharedText::SharedText(std::size_t capacity) : bytes_(sizeof(Shared) + capacity) {
  void* memory = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory != MAP_FAILED) shared_ = new (memory) Shared;
}

SharedText::~SharedText() {
  if (shared_ != nullptr) ::munmap(shared_, bytes_);
}

SharedText& SharedText::operator=(SharedText&& other) noexcept {
  std::swap(shared_, other.shared_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void SharedText::clear() {
  constexpr std::size_t many = 1 << 20;  // from this size on, pages are returned to the system
  if (shared_ == nullptr) return;
  const bool is_large = shared_->size.load() > many;
  shared_->size.store(0);
  if (is_large) (void)::madvise(shared_, bytes_, MADV_REMOVE);  // the pages read as zeros afterwards
}

bool SharedText::append(std::string_view piece) {
  if (shared_ == nullptr) return false;
  const std::size_t size = shared_->size.load(std::memory_order_relaxed);
  if (piece.size() > bytes_ - sizeof(Shared) - size) return false;
  std::memcpy(shared_->begin() + size, piece.data(), piece.size());
  shared_->size.store(size + piece.size(), std::memory_order_release);
  return true;
}

std::string_view SharedText::text() const {
  if (shared_ == nullptr) return {};
  return {shared_->begin(), shared_->size.load(std::memory_order_acquire)};
}

}  // namespace bough::io
