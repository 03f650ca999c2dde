#include "muslin/simulation/checkpoint.hpp"

#include <array>
#include <cstddef>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

constexpr std::array<char, 8> magic = {'M', 'U', 'S', 'L', 'I', 'N', 'C', 'P'};
constexpr std::uint64_t version = 3;

struct Preamble {
  std::array<char, 8> magic;
  std::uint64_t version;
  CheckpointHeader header;
};

[[noreturn]] void damaged(const std::string& how) {
  throw Error(ErrorKind::input, "the checkpoint is damaged: " + how,
              "resume from an earlier checkpoint or start the run anew");
}

}  // namespace

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed) {
  // FNV-1a over words of eight bytes, with a final mix (Murmur3's) so that every input bit reaches every
  // output bit.
  std::uint64_t hash = 0xcbf29ce484222325ULL ^ seed;
  const auto* bytes = static_cast<const unsigned char*>(data);
  const auto stir = [&hash](std::uint64_t word) {
    hash = (hash ^ word) * 0x100000001b3ULL;
    hash ^= hash >> 29;
  };
  std::size_t i = 0;
  for (; i + 8 <= size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, 8);
    stir(word);
  }
  std::uint64_t tail = size;
  for (; i < size; ++i) tail = (tail << 8) | bytes[i];
  stir(tail);
  hash = (hash ^ (hash >> 33)) * 0xff51afd7ed558ccdULL;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return hash ^ (hash >> 33);
}

std::uint64_t model_fingerprint(const Model& model) {
  std::uint64_t hash = hash_bytes(model.masses.data(), model.masses.size() * sizeof(double));
  hash = hash_bytes(model.rest_positions.data(), model.rest_positions.size() * sizeof(Vec3), hash);
  for (const Body& body : model.bodies) {
    hash = hash_bytes(body.name.data(), body.name.size(), hash);
    const std::array<std::int64_t, 3> shape = {body.first_vertex, body.vertex_count, body.springs.count};
    hash = hash_bytes(shape.data(), sizeof shape, hash);
    if (!body.is_shell()) continue;
    hash = hash_bytes(body.shell.triangles.data(), body.shell.triangles.size() * sizeof(Vec3i), hash);
    hash = hash_bytes(body.shell.inverses.data(), body.shell.inverses.size() * sizeof(Mat2), hash);
    hash = hash_bytes(body.shell.hinges.data(), body.shell.hinges.size() * sizeof(Hinge), hash);
  }
  for (const BodySettings& body : model.scene.bodies) {
    const Material& m = body.material;
    const std::array<double, 8> numbers = {m.density,
                                           m.edge_modulus,
                                           m.face_diagonal_modulus,
                                           m.body_diagonal_modulus,
                                           m.volume_modulus,
                                           m.mass_damping,
                                           m.stiffness_damping,
                                           static_cast<double>(body.boundary_springs)};
    hash = hash_bytes(numbers.data(), sizeof numbers, hash);
    if (body.model == BodyModel::shell) hash = hash_bytes(&*m.shell, sizeof *m.shell, hash);
  }
  return hash;
}

CheckpointHeader read_checkpoint_header(std::span<const std::uint8_t> bytes) {
  Preamble preamble{};
  if (bytes.size() < sizeof preamble + sizeof(std::uint64_t)) damaged("it is cut off");
  std::memcpy(&preamble, bytes.data(), sizeof preamble);
  if (preamble.magic != magic) {
    throw Error(ErrorKind::input, "this is not a muslin checkpoint", "name a checkpoint that muslin wrote");
  }
  if (preamble.version != version) {
    throw Error(ErrorKind::input,
                "the checkpoint has format " + std::to_string(preamble.version) + ", this muslin reads " +
                    std::to_string(version),
                "resume with the version that wrote it, or start the run anew");
  }
  std::uint64_t checksum = 0;
  const std::size_t body = bytes.size() - sizeof checksum;
  std::memcpy(&checksum, bytes.data() + body, sizeof checksum);
  if (checksum != hash_bytes(bytes.data(), body)) damaged("its checksum is wrong");
  return preamble.header;
}

ByteWriter::ByteWriter(const CheckpointHeader& header) { value(Preamble{magic, version, header}); }

void ByteWriter::append(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  bytes_.insert(bytes_.end(), bytes, bytes + size);
}

void ByteWriter::text(const std::string& text) {
  value(static_cast<std::uint64_t>(text.size()));
  append(text.data(), text.size());
}

std::vector<std::uint8_t> ByteWriter::finish() && {
  value(hash_bytes(bytes_.data(), bytes_.size()));
  return std::move(bytes_);
}

ByteReader::ByteReader(std::span<const std::uint8_t> bytes) {
  read_checkpoint_header(bytes);
  rest_ = bytes.subspan(sizeof(Preamble), bytes.size() - sizeof(Preamble) - sizeof(std::uint64_t));
}

void ByteReader::require(std::uint64_t count, std::size_t size) const {
  if (count > rest_.size() / size) damaged("it ends too early");
}

void ByteReader::take(void* data, std::size_t size) {
  require(size, 1);
  if (size > 0) std::memcpy(data, rest_.data(), size);
  rest_ = rest_.subspan(size);
}

std::string ByteReader::text() {
  const auto size = value<std::uint64_t>();
  require(size, 1);
  std::string result(size, '\0');
  take(result.data(), size);
  return result;
}

}  // namespace muslin
