#include "transfers.hpp"

#include <immintrin.h>

#include <algorithm>
#include <limits>

#include "bough/solve/element_view.hpp"

namespace bough::solve {

namespace {

void fetch_packs(const double* packs, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) __builtin_prefetch(packs + i * lanes_wide, 0, 2);
}

void write_packs(const double* from, std::int64_t count, double* to) {
#if defined(__AVX512F__)
  for (std::int64_t i = 0; i < count * lanes_wide; i += 8) _mm512_stream_pd(to + i, _mm512_load_pd(from + i));
#elif defined(__AVX__)
  for (std::int64_t i = 0; i < count * lanes_wide; i += 4) _mm256_stream_pd(to + i, _mm256_load_pd(from + i));
#else
  for (std::int64_t i = 0; i < count * lanes_wide; i += 2) _mm_stream_pd(to + i, _mm_load_pd(from + i));
#endif
}

}  // namespace

void Transfers::add(const double* from, double* to, std::int64_t count) {
  if (count_ == room) finish();
  ranges_[count_++] = {from, to, count};
  waiting_ += count;
}

void Transfers::spread(int steps) { share_ = (waiting_ + steps - 1) / std::max(steps, 1); }

void Transfers::move(std::int64_t count) {
  while (count > 0 && next_ < count_) {
    const Range& range = ranges_[next_];
    const std::int64_t some = std::min(count, range.count - done_);
    if (range.to == nullptr)
      fetch_packs(range.from + done_ * lanes_wide, some);
    else
      write_packs(range.from + done_ * lanes_wide, some, range.to + done_ * lanes_wide);
    count -= some;
    done_ += some;
    waiting_ -= some;
    if (done_ < range.count) return;
    ++next_;
    done_ = 0;
  }
}

void Transfers::finish() {
  move(std::numeric_limits<std::int64_t>::max());
  count_ = next_ = 0;
}

void Transfers::end_writes() { _mm_sfence(); }

}  // namespace bough::solve
