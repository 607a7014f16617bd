#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// What a user hands over as bytes: for libFuzzer, for the corpus and for the mutations that the
/// tests make of it.
namespace nuvo::fuzz {

/// One kind of input.
struct Target {
    const char* name;                ///< of its folder in tests/fuzz/corpus
    void (*take)(std::string_view);  ///< throws std::logic_error where a promise is broken
    std::vector<std::string> words;  ///< of its language
};

/// The text of an X3D file: read, or refused by one line; all numbers finite.
void take_scene(std::string_view bytes);
/// The text of a file for --rays.
void take_rays(std::string_view bytes);
/// A command line, its arguments separated by line ends or zero bytes.
void take_options(std::string_view bytes);

const std::vector<Target>& targets();

/// The files of the target's corpus, in the order of their names.
std::vector<std::string> corpus_of(const Target& target);

/// One of `corpus`, changed by a few random cuts, repetitions, words, numbers and bytes.
std::string mutated(const std::vector<std::string>& corpus, const Target& target,
                    std::uint64_t seed);

}  // namespace nuvo::fuzz
