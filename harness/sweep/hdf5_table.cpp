#include "harness/sweep/hdf5_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include "harness/core/dynamic_library.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are");

// The functions of libhdf5 that are in use, loaded when the first file is made. The library is not
// linked, because it would bring more than 30 others (curl, Kerberos) into each process.
struct Hdf5Library {
  DynamicLibrary library;
  decltype(&::H5open) open = nullptr;
  decltype(&::H5Eset_auto2) set_error_printer = nullptr;
  decltype(&::H5Pcreate) create_properties = nullptr;
  decltype(&::H5Pclose) close_properties = nullptr;
  decltype(&::H5Pset_fapl_core) set_in_memory = nullptr;
  decltype(&::H5Pset_obj_track_times) set_track_times = nullptr;
  decltype(&::H5Fcreate) create_file = nullptr;
  decltype(&::H5Fflush) flush_file = nullptr;
  decltype(&::H5Fget_file_image) get_file_image = nullptr;
  decltype(&::H5Fclose) close_file = nullptr;
  decltype(&::H5Screate) create_space = nullptr;
  decltype(&::H5Screate_simple) create_simple_space = nullptr;
  decltype(&::H5Sclose) close_space = nullptr;
  decltype(&::H5Tcopy) copy_type = nullptr;
  decltype(&::H5Tset_size) set_type_size = nullptr;
  decltype(&::H5Tenum_create) create_enum = nullptr;
  decltype(&::H5Tenum_insert) insert_in_enum = nullptr;
  decltype(&::H5Tclose) close_type = nullptr;
  decltype(&::H5Dcreate2) create_dataset = nullptr;
  decltype(&::H5Dwrite) write_dataset = nullptr;
  decltype(&::H5Dclose) close_dataset = nullptr;
  decltype(&::H5Acreate2) create_attribute = nullptr;
  decltype(&::H5Awrite) write_attribute = nullptr;
  decltype(&::H5Aclose) close_attribute = nullptr;
  // The identifiers have their values after open(). The numbers are little-endian.
  const hid_t* float64 = nullptr;
  const hid_t* uint64 = nullptr;
  const hid_t* uint8 = nullptr;
  const hid_t* text = nullptr;
  const hid_t* of_file_access = nullptr;
  const hid_t* of_dataset = nullptr;
};

bool find_all(const DynamicLibrary& in, Hdf5Library& hdf5) {
  return in.find("H5open", hdf5.open) && in.find("H5Eset_auto2", hdf5.set_error_printer) &&
         in.find("H5Pcreate", hdf5.create_properties) &&
         in.find("H5Pclose", hdf5.close_properties) &&
         in.find("H5Pset_fapl_core", hdf5.set_in_memory) &&
         in.find("H5Pset_obj_track_times", hdf5.set_track_times) &&
         in.find("H5Fcreate", hdf5.create_file) && in.find("H5Fflush", hdf5.flush_file) &&
         in.find("H5Fget_file_image", hdf5.get_file_image) &&
         in.find("H5Fclose", hdf5.close_file) && in.find("H5Screate", hdf5.create_space) &&
         in.find("H5Screate_simple", hdf5.create_simple_space) &&
         in.find("H5Sclose", hdf5.close_space) && in.find("H5Tcopy", hdf5.copy_type) &&
         in.find("H5Tset_size", hdf5.set_type_size) &&
         in.find("H5Tenum_create", hdf5.create_enum) &&
         in.find("H5Tenum_insert", hdf5.insert_in_enum) && in.find("H5Tclose", hdf5.close_type) &&
         in.find("H5Dcreate2", hdf5.create_dataset) && in.find("H5Dwrite", hdf5.write_dataset) &&
         in.find("H5Dclose", hdf5.close_dataset) && in.find("H5Acreate2", hdf5.create_attribute) &&
         in.find("H5Awrite", hdf5.write_attribute) && in.find("H5Aclose", hdf5.close_attribute);
}

// The variables behind macros such as H5T_IEEE_F64LE, which call H5open() at each use.
bool find_identifiers(const DynamicLibrary& in, Hdf5Library& hdf5) {
  return in.find("H5T_IEEE_F64LE_g", hdf5.float64) && in.find("H5T_STD_U64LE_g", hdf5.uint64) &&
         in.find("H5T_STD_U8LE_g", hdf5.uint8) && in.find("H5T_C_S1_g", hdf5.text) &&
         in.find("H5P_CLS_FILE_ACCESS_ID_g", hdf5.of_file_access) &&
         in.find("H5P_CLS_DATASET_CREATE_ID_g", hdf5.of_dataset);
}

Result<Hdf5Library> load_hdf5() {
  auto library = DynamicLibrary::open(ATTEST_HDF5_SONAME);
  if (!library) {
    return fail("HDF5 files need libhdf5: " + library.error().message);
  }
  Hdf5Library hdf5{*library};
  if (!find_all(*library, hdf5) || !find_identifiers(*library, hdf5) || hdf5.open() < 0) {
    return fail(ATTEST_HDF5_SONAME " has not all functions of hdf5.h");
  }
  // By default libhdf5 prints its errors; attest reports them instead.
  hdf5.set_error_printer(H5E_DEFAULT, nullptr, nullptr);
  return hdf5;
}

const Result<Hdf5Library>& loaded_hdf5() {
  static const Result<Hdf5Library> hdf5 = load_hdf5();
  return hdf5;
}

// Owns an object of the library. An id below 0: the object could not be made.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  bool is_good() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

using Attributes = std::vector<std::pair<std::string, std::string>>;

// An HDF5 file in memory. bytes() is empty if the file could not be made.
class Hdf5File {
 public:
  explicit Hdf5File(const Hdf5Library& hdf5)
      : hdf5_(hdf5),
        access_(hdf5.create_properties(*hdf5.of_file_access), hdf5.close_properties),
        file_(create(), hdf5.close_file) {
    note(file_.is_good());
  }

  template <typename Value>
  void add(const std::string& name, hid_t type, const std::vector<Value>& values,
           const Attributes& attributes) {
    const auto count = static_cast<hsize_t>(values.size());
    const Handle space(hdf5_.create_simple_space(1, &count, nullptr), hdf5_.close_space);
    const Handle properties(hdf5_.create_properties(*hdf5_.of_dataset), hdf5_.close_properties);
    hdf5_.set_track_times(properties.get(), false);  // the same table gives the same bytes
    const Handle dataset(hdf5_.create_dataset(file_.get(), name.c_str(), type, space.get(),
                                              H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                         hdf5_.close_dataset);
    note(hdf5_.write_dataset(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >=
         0);
    describe(dataset.get(), attributes);
  }
  void describe(const Attributes& attributes) { describe(file_.get(), attributes); }

  std::string bytes() {
    note(hdf5_.flush_file(file_.get(), H5F_SCOPE_LOCAL) >= 0);
    const ssize_t size = hdf5_.get_file_image(file_.get(), nullptr, 0);
    if (!is_good_ || size <= 0) return "";
    std::string bytes(static_cast<std::size_t>(size), '\0');
    const ssize_t read = hdf5_.get_file_image(file_.get(), bytes.data(), bytes.size());
    return read == size ? bytes : "";
  }

 private:
  hid_t create() {
    constexpr std::size_t increment = std::size_t{1} << 24;
    constexpr unsigned truncate = 2;  // H5F_ACC_TRUNC, a macro that also calls the library
    if (hdf5_.set_in_memory(access_.get(), increment, false) < 0) return -1;
    return hdf5_.create_file("in memory", truncate, H5P_DEFAULT, access_.get());
  }

  void describe(hid_t object, const Attributes& attributes) {
    for (const auto& [name, value] : attributes) {
      if (value.empty()) continue;
      const Handle type(hdf5_.copy_type(*hdf5_.text), hdf5_.close_type);
      note(hdf5_.set_type_size(type.get(), value.size() + 1) >= 0);  // with the final 0
      const Handle space(hdf5_.create_space(H5S_SCALAR), hdf5_.close_space);
      const Handle attribute(hdf5_.create_attribute(object, name.c_str(), type.get(), space.get(),
                                                    H5P_DEFAULT, H5P_DEFAULT),
                             hdf5_.close_attribute);
      note(hdf5_.write_attribute(attribute.get(), type.get(), value.c_str()) >= 0);
    }
  }

  void note(bool is_good) { is_good_ = is_good_ && is_good; }

  const Hdf5Library& hdf5_;
  Handle access_, file_;
  bool is_good_ = true;
};

// The names of the enumeration of outcomes, each at the index that is its number.
std::vector<std::string> outcome_names() {
  std::vector<std::string> names = {outcome_done, outcome_diverged};
  for (int i = 0; i < verdict_count; ++i) names.emplace_back(name_of(static_cast<Verdict>(i)));
  return names;
}

class OutcomeType {
 public:
  explicit OutcomeType(const Hdf5Library& hdf5)
      : names_(outcome_names()), type_(hdf5.create_enum(*hdf5.uint8), hdf5.close_type) {
    for (std::uint8_t i = 0; i < names_.size(); ++i) {
      hdf5.insert_in_enum(type_.get(), names_[i].c_str(), &i);
    }
  }

  hid_t get() const { return type_.get(); }
  std::vector<std::uint8_t> numbers_of(const std::vector<std::string>& outcomes) const {
    std::vector<std::uint8_t> numbers;
    for (const std::string& outcome : outcomes) {
      const auto place = std::find(names_.begin(), names_.end(), outcome) - names_.begin();
      numbers.push_back(static_cast<std::uint8_t>(place));
    }
    return numbers;
  }

 private:
  std::vector<std::string> names_;
  Handle type_;
};

Attributes attributes_of(const Dispersion& dispersion) {
  constexpr std::array<const char*, 3> as = {"value", "factor", "offset"};
  std::vector<std::string> keys;
  for (const DispersedKey& key : dispersion.keys) {
    const bool is_of_vehicle = key.document == DispersedKey::Document::vehicle;
    keys.push_back((is_of_vehicle ? "vehicle." : "case.") + key.path);
  }
  return {{"keys", fmt::format("{}", fmt::join(keys, " "))},
          {"as", as[static_cast<std::size_t>(dispersion.as)]}};
}

Attributes attributes_of(const FlightSampler& sampler, const SweepIdentity& identity) {
  const SweepFile& sweep = sampler.sweep();
  const PlantConfiguration& plant = sampler.nominal().plant_configuration;
  return {{"attest", identity.attest_version},
          {"sweep_sha256", identity.sweep_sha256},
          {"port", identity.port},
          {"port_sha256", identity.port_sha256},
          {"case", sampler.nominal().the_case.id()},
          {"rate", sweep.rate.to_string()},
          {"vehicle", plant.vehicle},
          {"plant", std::string(name_of(plant.plant))},
          {"design", std::string(name_of(sweep.design.kind))}};
}

void add_pilot(const Hdf5Library& hdf5, const FlightSampler& sampler, const SampleColumns& columns,
               const PilotData& pilot, const std::string& name, Hdf5File& file) {
  const OutcomeType outcomes(hdf5);
  file.add(name + ".outcome", outcomes.get(), outcomes.numbers_of(pilot.outcomes), {});
  const auto& metrics = sampler.nominal().the_case.flight->metrics;
  for (std::size_t i = 0; i < columns.metrics.size(); ++i) {
    file.add(name + "." + columns.metrics[i], *hdf5.float64, pilot.metrics[i],
             {{"measure", std::string(name_of(metrics[i].measure))}});
  }
}

}  // namespace

Result<std::string> hdf5_table(const FlightSampler& sampler, const SweepIdentity& identity,
                               const SampleColumns& columns, const SampleData& data) {
  const auto& hdf5 = loaded_hdf5();
  if (!hdf5) return tl::unexpected(hdf5.error());
  Hdf5File file(*hdf5);
  file.describe(attributes_of(sampler, identity));
  std::vector<std::uint64_t> samples(data.samples());
  std::iota(samples.begin(), samples.end(), std::uint64_t{0});
  file.add("sample", *hdf5->uint64, samples, {});
  for (std::size_t i = 0; i < columns.dispersions.size(); ++i) {
    file.add(columns.dispersions[i], *hdf5->float64, data.drawn[i],
             attributes_of(sampler.sweep().dispersions[i]));
  }
  for (std::size_t i = 0; i < data.pilots.size(); ++i) {
    add_pilot(*hdf5, sampler, columns, data.pilots[i], i == 0 ? "reference" : "port", file);
  }
  std::string bytes = file.bytes();
  if (bytes.empty()) return fail("libhdf5 cannot make the file");
  return bytes;
}

}  // namespace attest
