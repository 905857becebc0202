// Light, and perhaps a ground, for models that have none.
#pragma once

#include <string_view>

#include "scene/names.h"
#include "scene/scene.h"

namespace candela {

// Whether a studio lights a scene, and which.
enum class StudioChoice {
    automatic,  // The standard one, if nothing else lights the scene of a glTF file.
    off,
    standard,  // These in any case, and in place of an environment.
    softbox,
    white,
    overcast,
    sunset,
};
inline constexpr Choices<StudioChoice, 7> STUDIO_NAMES{{{"auto", StudioChoice::automatic},
                                                        {"off", StudioChoice::off},
                                                        {"default", StudioChoice::standard},
                                                        {"softbox", StudioChoice::softbox},
                                                        {"white", StudioChoice::white},
                                                        {"overcast", StudioChoice::overcast},
                                                        {"sunset", StudioChoice::sunset}}};

// The light of a studio, which is not `automatic` or `off`:
//   standard  A large soft light above and to the left, a weaker one to the right, a strip behind, a pale
//   floor
//             and dim walls. White paper in it has a radiance of up to 0.95.
//   softbox   A dark room with a large square light in front on the left, a tall strip on the right and a
//   wide
//             one above from behind: reflections with edges.
//   white     White all around, of radiance 1, and a soft light above.
//   overcast  The sky of the CIE for overcast days: above, three times as bright as at the horizon.
//   sunset    A low sun on the left, with a sky that is warm around it and blue above.
// The camera does not see the first two. White paper that lies in the others has a radiance of 1.25, 0.9 and
// 0.5.
Environment studio_environment(StudioChoice studio);

// The attribute of a scene that has the name of its studio.
inline constexpr const char* STUDIO_ATTRIBUTE = "candela.studio";

// Whether the camera sees nothing of the studio of that name, so that pictures for the screen stand before a
// grey.
bool is_unseen_studio(std::string_view name);

// Gives the scene the studio's light and its name. The last three also get a ground, just below the scene's
// lowest point: a disk thirty times as large as the scene, as bright as the studio is below its horizon.
// `white` has one that looks like its sky, except in shadows.
void put_into_studio(Scene& scene, StudioChoice studio);

}  // namespace candela
