// Compositing of arrays over the ranks of an mpi4py communicator.
#include <pybind11/stl.h>

#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "comm/agree_on_failure.h"
#include "comm/mpi.h"
#include "composite/codec.h"
#include "composite/compose_images.h"
#include "composite/scheme.h"
#include "python/arrays.h"
#include "python/render/communicator.h"
#include "python/render/module.h"
#include "python/render/picture.h"
#include "python/work.h"

namespace py = pybind11;

namespace delray::python {
namespace {

using Depth = py::array_t<float, py::array::c_style | py::array::forcecast>;

template <class Colour>
py::object compose_as(MpiRanks& ranks, const py::array& colours, const std::optional<Depth>& depth,
                      float empty_depth, const composite::ImageOptions& options, int threads) {
  composite::ImageBuffers<Colour> buffers;
  buffers.height = static_cast<int>(colours.shape(0));
  buffers.width = static_cast<int>(colours.shape(1));
  buffers.colour = static_cast<const Colour*>(colours.data());
  buffers.depth = depth ? depth->data() : nullptr;
  image::BasicImage<Colour> whole = run({threads}, [&](parallel::Progress&) {
    return composite::compose_images(*ranks.communicator, buffers, empty_depth, options);
  });
  if (ranks.communicator->rank() != options.root) return py::none();
  py::array picture = array_of(std::move(whole.colour), whole.width, whole.height);
  if (!depth) return py::make_tuple(picture, py::none());
  return py::make_tuple(picture, array_of(std::move(whole.depth), whole.width, whole.height));
}

// The arguments of one rank, checked.
struct Images {
  py::array colours;
  std::optional<Depth> depth;
};

Images checked(const py::object& rgba, const py::object& depth, const std::string& codec) {
  Images result;
  result.colours = py::array::ensure(rgba, py::array::c_style);
  const py::array& colours = result.colours;
  if (!colours || colours.ndim() != 3 || colours.shape(2) != 4) {
    PyErr_Clear();
    throw std::invalid_argument("rgba: not an array of (height, width, 4)");
  }
  if (!colours.dtype().is(py::dtype::of<std::uint8_t>()) &&
      !colours.dtype().is(py::dtype::of<float>())) {
    throw std::invalid_argument("rgba: " + std::string(py::str(colours.dtype())) +
                                " is neither uint8 nor float32");
  }
  if (composite::find_codec(codec) == nullptr)
    throw std::invalid_argument("there is no codec '" + codec + "'");
  if (depth.is_none()) return result;
  result.depth.emplace(depth);
  const Depth& depths = *result.depth;
  if (depths.ndim() != 2 || depths.shape(0) != colours.shape(0) ||
      depths.shape(1) != colours.shape(1)) {
    throw std::invalid_argument("depth: not an array of (height, width), as rgba is");
  }
  for (py::ssize_t i = 0; i < depths.size(); ++i) {
    if (depths.data()[i] != depths.data()[i])
      throw std::invalid_argument("depth: that of pixel " + std::to_string(i) + " is not a number");
  }
  return result;
}

py::object compose(MpiRanks& ranks, const py::object& rgba, const py::object& depth,
                   const std::string& scheme, const std::string& codec, bool interlace, int root,
                   float empty_depth, std::optional<int> threads) {
  Images images;
  std::exception_ptr failure;
  int workers = 1;
  try {
    images = checked(rgba, depth, codec);
    workers = thread_count(threads.value_or(1));
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  {
    // Nobody waits for a rank whose arguments are wrong.
    const py::gil_scoped_release unlocked;
    comm::agree_on_failure(*ranks.communicator, failure, comm::Phase::other);
  }
  composite::ImageOptions options;
  options.how = images.depth ? composite::Operator::nearest : composite::Operator::over;
  options.scheme = scheme;
  options.codec = codec;
  options.interlace = interlace;
  options.root = root;
  if (images.colours.dtype().is(py::dtype::of<float>())) {
    return compose_as<image::RgbaF>(ranks, images.colours, images.depth, empty_depth, options,
                                    workers);
  }
  return compose_as<image::Rgba8>(ranks, images.colours, images.depth, empty_depth, options,
                                  workers);
}

template <class Table>
py::dict table(const Table& rows) {
  py::dict result;
  for (const auto& row : rows)
    result[py::str(std::string(row.name))] = std::string(row.description);
  return result;
}

}  // namespace

void add_communicator(py::module_& module) {
  using namespace py::literals;
  py::class_<MpiRanks>(module, "Communicator")
      .def(py::init([](std::uintptr_t address) {
             auto ranks = std::make_unique<MpiRanks>();
             ranks->communicator =
                 comm::make_mpi_communicator(reinterpret_cast<const void*>(address));
             return ranks;
           }),
           "address"_a)
      .def_property_readonly("rank", [](const MpiRanks& r) { return r.communicator->rank(); })
      .def_property_readonly("size", [](const MpiRanks& r) { return r.communicator->size(); });
  module.def("compose", &compose, "communicator"_a, "rgba"_a, "depth"_a, "scheme"_a, "codec"_a,
             "interlace"_a, "root"_a, "empty_depth"_a, "threads"_a);
  module.def("schemes", [] { return table(composite::schemes()); });
  module.def("codecs", [] { return table(composite::codecs()); });
}

}  // namespace delray::python
