// Rows of four numbers in memory, one per lane, from and to four vectors: vectors of structures are
// read from and written to scattered places with whole rows at a time.
//
// Compiled once per instruction set, so it has a guard of Highway's kind.
#if defined(DELRAY_RASTER_TRANSPOSE) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_RASTER_TRANSPOSE
#undef DELRAY_RASTER_TRANSPOSE
#else
#define DELRAY_RASTER_TRANSPOSE
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A vector's worth of rows: vector k has element k of each.
template <class V>
struct FourVectors {
  V v[4];
};

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE

template <class D, class Row>
HWY_INLINE FourVectors<hn::Vec<D>> load_rows(D d, const Row& row) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T rows[4 * 16];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i)
    for (std::size_t k = 0; k < 4; ++k) rows[4 * i + k] = row(i)[k];
  FourVectors<hn::Vec<D>> result;
  hn::LoadInterleaved4(d, rows, result.v[0], result.v[1], result.v[2], result.v[3]);
  return result;
}

template <class D, class Row>
HWY_INLINE void store_rows(D d, const FourVectors<hn::Vec<D>>& vectors, const Row& row) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T rows[4 * 16];
  hn::StoreInterleaved4(vectors.v[0], vectors.v[1], vectors.v[2], vectors.v[3], d, rows);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i)
    for (std::size_t k = 0; k < 4; ++k) row(i)[k] = rows[4 * i + k];
}

#else

// Four by four, within each block of four lanes.
template <class D, class V>
HWY_INLINE FourVectors<V> transposed_blocks(D d, V r0, V r1, V r2, V r3) {
  const hn::Repartition<std::uint64_t, D> d64;
  const auto low01 = hn::BitCast(d64, hn::InterleaveLower(d, r0, r1));
  const auto low23 = hn::BitCast(d64, hn::InterleaveLower(d, r2, r3));
  const auto high01 = hn::BitCast(d64, hn::InterleaveUpper(d, r0, r1));
  const auto high23 = hn::BitCast(d64, hn::InterleaveUpper(d, r2, r3));
  return {{hn::BitCast(d, hn::InterleaveLower(d64, low01, low23)),
           hn::BitCast(d, hn::InterleaveUpper(d64, low01, low23)),
           hn::BitCast(d, hn::InterleaveLower(d64, high01, high23)),
           hn::BitCast(d, hn::InterleaveUpper(d64, high01, high23))}};
}

// Block i of the vector is what row(first + 4 * i) gives, a vector of four.
template <class D, class Row>
HWY_INLINE hn::Vec<D> blocks_of(D d, std::size_t first, const Row& row) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return row(first);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, blocks_of(half, first + hn::MaxLanes(half), row),
                       blocks_of(half, first, row));
  }
}

// Of rows that are vectors of four: lane i belongs to row(i).
template <class D, class Row>
HWY_INLINE FourVectors<hn::Vec<D>> transposed_rows(D d, const Row& row) {
  return transposed_blocks(d, blocks_of(d, 0, row), blocks_of(d, 1, row), blocks_of(d, 2, row),
                           blocks_of(d, 3, row));
}

template <class D, class V, class Row>
HWY_INLINE void store_blocks(D d, V vector, std::size_t first, const Row& row) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    hn::StoreU(vector, d, row(first));
  } else {
    const hn::Half<D> half;
    store_blocks(half, hn::LowerHalf(half, vector), first, row);
    store_blocks(half, hn::UpperHalf(half, vector), first + hn::MaxLanes(half), row);
  }
}

// Lane i has the four numbers at row(i).
template <class D, class Row>
HWY_INLINE FourVectors<hn::Vec<D>> load_rows(D d, const Row& row) {
  const hn::CappedTag<hn::TFromD<D>, 4> four;
  return transposed_rows(d, [&](std::size_t i) HWY_ATTR { return hn::LoadU(four, row(i)); });
}

template <class D, class Row>
HWY_INLINE void store_rows(D d, const FourVectors<hn::Vec<D>>& vectors, const Row& row) {
  const auto& v = vectors.v;
  const auto rows = transposed_blocks(d, v[0], v[1], v[2], v[3]);
  for (std::size_t k = 0; k < 4; ++k) store_blocks(d, rows.v[k], k, row);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#endif
