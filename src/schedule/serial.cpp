#include "bough/schedule/serial.hpp"

#include <algorithm>

namespace bough::schedule {

namespace {

void up(void*, const tree::Tree& tree, tree::Visit visit) {
  for (tree::SubdomainId s = 0; s <= tree.root(); ++s) visit.run(visit.context, s);
}

void down(void*, const tree::Tree& tree, tree::Visit visit) {
  for (tree::SubdomainId s = tree.root(); s >= 0; --s) visit.run(visit.context, s);
}

void each(void*, std::int64_t count, std::int64_t grain, tree::Chunk chunk) {
  for (std::int64_t begin = 0; begin < count; begin += grain)
    chunk.run(chunk.context, begin, std::min(begin + grain, count));
}

}  // namespace

tree::Walker make_serial_walker() { return {up, down, each, nullptr}; }

}  // namespace bough::schedule
