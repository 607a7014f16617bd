// Renders a scene with nuvo as a library: embed SCENE.x3d PICTURE.bmp. The picture is the one of
// `nuvo --profile=fast`, to the byte.
#include <exception>
#include <iostream>

#include "nuvo/image/bmp.h"
#include "nuvo/render/fast.h"
#include "nuvo/scene/x3d.h"

int main(int argc, char** argv) try {
    if (argc != 3) {
        std::cerr << "usage: embed SCENE.x3d PICTURE.bmp\n";
        return 2;
    }
    const nuvo::Scene scene = nuvo::x3d::read_file(argv[1]);
    const nuvo::Primitives primitives = nuvo::flatten(scene, nuvo::LeafContent::kPrimitives);
    nuvo::FastTracer tracer(scene, primitives, {});  // builds the octree
    nuvo::image::write_bmp(argv[2], tracer.render({640, 360}));

    const nuvo::Ray ray{scene.camera.position, {0, 0, -1}};  // or any other question
    const nuvo::RayAnswer answer = tracer.closest_hits({&ray, 1}).front();
    std::cout << scene.objects.size() << " shapes; the ray along -z ";
    if (answer.hit) {
        std::cout << "meets one at t = " << answer.t << '\n';
    } else {
        std::cout << "meets none\n";
    }
} catch (const std::exception& error) {
    std::cerr << "embed: " << error.what() << '\n';
    return 1;
}
