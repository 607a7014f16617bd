#include "node_names.h"

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace nuvo::x3d {

namespace {

// Made when it is first asked for: what fails before main() cannot be told.
const std::unordered_set<std::string_view>& silent_names() {
    static const std::unordered_set<std::string_view> names{"",
                                                            "EXPORT",
                                                            "ExternProtoDeclare",
                                                            "FontStyle",
                                                            "IS",
                                                            "MetadataBoolean",
                                                            "MetadataDouble",
                                                            "MetadataFloat",
                                                            "MetadataInteger",
                                                            "MetadataSet",
                                                            "MetadataString",
                                                            "MultiTextureCoordinate",
                                                            "ProtoDeclare",
                                                            "ProtoInterface",
                                                            "TextureCoordinate",
                                                            "TextureCoordinate3D",
                                                            "TextureCoordinate4D",
                                                            "TextureCoordinateGenerator",
                                                            "WorldInfo",
                                                            "component",
                                                            "head",
                                                            "meta",
                                                            "unit"};
    return names;
}

/// The nodes and statements of X3D 3.0 to 4.0 (ISO/IEC 19775-1 and 19776-1).
constexpr std::string_view kNames =
    "AcousticProperties Analyser Anchor Appearance Arc2D ArcClose2D AudioClip AudioDestination "
    "Background BallJoint Billboard BiquadFilter BlendedVolumeStyle BooleanFilter BooleanSequencer "
    "BooleanToggle BooleanTrigger BoundaryEnhancementVolumeStyle BoundedPhysicsModel Box "
    "BufferAudioSource CADAssembly CADFace CADLayer CADPart CartoonVolumeStyle ChannelMerger "
    "ChannelSelector ChannelSplitter Circle2D ClipPlane CollidableOffset CollidableShape Collision "
    "CollisionCollection CollisionSensor CollisionSpace Color ColorChaser ColorDamper "
    "ColorInterpolator ColorRGBA ComposedCubeMapTexture ComposedShader ComposedTexture3D "
    "ComposedVolumeStyle Cone ConeEmitter Contact Contour2D ContourPolyline2D Convolver Coordinate "
    "CoordinateChaser CoordinateDamper CoordinateDouble CoordinateInterpolator "
    "CoordinateInterpolator2D Cylinder CylinderSensor DISEntityManager DISEntityTypeMapping Delay "
    "DirectionalLight Disk2D DoubleAxisHingeJoint DynamicsCompressor EXPORT EaseInEaseOut "
    "EdgeEnhancementVolumeStyle ElevationGrid EnvironmentLight EspduTransform ExplosionEmitter "
    "ExternProtoDeclare Extrusion FillProperties FloatVertexAttribute Fog FogCoordinate FontStyle "
    "ForcePhysicsModel Gain GeneratedCubeMapTexture GeoCoordinate GeoElevationGrid GeoLOD "
    "GeoLocation GeoMetadata GeoOrigin GeoPositionInterpolator GeoProximitySensor GeoTouchSensor "
    "GeoTransform GeoViewpoint Group HAnimDisplacer HAnimHumanoid HAnimJoint HAnimMotion "
    "HAnimSegment HAnimSite IMPORT IS ImageCubeMapTexture ImageTexture ImageTexture3D "
    "ImageTextureAtlas IndexedFaceSet IndexedLineSet IndexedQuadSet IndexedTriangleFanSet "
    "IndexedTriangleSet IndexedTriangleStripSet Inline IntegerSequencer IntegerTrigger "
    "IsoSurfaceVolumeData KeySensor LOD Layer LayerSet Layout LayoutGroup LayoutLayer "
    "LinePickSensor LineProperties LineSet ListenerPointSource LoadSensor LocalFog Material "
    "Matrix3VertexAttribute Matrix4VertexAttribute MetadataBoolean MetadataDouble MetadataFloat "
    "MetadataInteger MetadataSet MetadataString MicrophoneSource MotorJoint MovieTexture "
    "MultiTexture MultiTextureCoordinate MultiTextureTransform NavigationInfo Normal "
    "NormalInterpolator NurbsCurve NurbsCurve2D NurbsOrientationInterpolator NurbsPatchSurface "
    "NurbsPositionInterpolator NurbsSet NurbsSurfaceInterpolator NurbsSweptSurface "
    "NurbsSwungSurface NurbsTextureCoordinate NurbsTrimmedSurface OpacityMapVolumeStyle "
    "OrientationChaser OrientationDamper OrientationInterpolator OrthoViewpoint OscillatorSource "
    "PackagedShader ParticleSystem PeriodicWave PhysicalMaterial PickableGroup PixelTexture "
    "PixelTexture3D PlaneSensor PointEmitter PointLight PointPickSensor PointProperties PointSet "
    "Polyline2D PolylineEmitter Polypoint2D PositionChaser PositionChaser2D PositionDamper "
    "PositionDamper2D PositionInterpolator PositionInterpolator2D PrimitivePickSensor "
    "ProgramShader "
    "ProjectionVolumeStyle ProtoBody ProtoDeclare ProtoInstance ProtoInterface ProximitySensor "
    "QuadSet ROUTE ReceiverPdu Rectangle2D RigidBody RigidBodyCollection ScalarChaser ScalarDamper "
    "ScalarInterpolator Scene ScreenFontStyle ScreenGroup Script SegmentedVolumeData "
    "ShadedVolumeStyle ShaderPart ShaderProgram Shape SignalPdu SilhouetteEnhancementVolumeStyle "
    "SingleAxisHingeJoint SliderJoint Sound SpatialSound Sphere SphereSensor "
    "SplinePositionInterpolator SplinePositionInterpolator2D SplineScalarInterpolator SpotLight "
    "SquadOrientationInterpolator StaticGroup StreamAudioDestination StreamAudioSource "
    "StringSensor "
    "SurfaceEmitter Switch TexCoordChaser2D TexCoordDamper2D Text TextureBackground "
    "TextureCoordinate TextureCoordinate3D TextureCoordinate4D TextureCoordinateGenerator "
    "TextureProjector TextureProjectorParallel TextureProperties TextureTransform "
    "TextureTransform3D TextureTransformMatrix3D TimeSensor TimeTrigger ToggleGroup "
    "ToneMappedVolumeStyle TouchSensor Transform TransformSensor TransmitterPdu TriangleFanSet "
    "TriangleSet TriangleSet2D TriangleStripSet TwoSidedMaterial UniversalJoint UnlitMaterial "
    "Viewpoint ViewpointGroup Viewport VisibilitySensor VolumeData VolumeEmitter VolumePickSensor "
    "WaveShaper WindPhysicsModel WorldInfo X3D component connect field fieldValue head meta unit";

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

std::unordered_map<std::string, std::string_view> spellings() {
    std::unordered_map<std::string, std::string_view> result;
    for (std::string_view rest = kNames; !rest.empty();) {
        const std::string_view name = rest.substr(0, rest.find(' '));
        rest.remove_prefix(std::min(rest.size(), name.size() + 1));
        result.emplace(lower(name), name);
    }
    return result;
}

}  // namespace

NodeKind node_kind(std::string_view name) {
    static const std::unordered_map<std::string_view, NodeKind> kinds{
        {"Anchor", NodeKind::kGroup},
        {"Background", NodeKind::kBackground},
        {"Billboard", NodeKind::kGroup},
        {"CADAssembly", NodeKind::kGroup},
        {"CADFace", NodeKind::kGroup},
        {"CADLayer", NodeKind::kGroup},
        {"CADPart", NodeKind::kTransform},
        {"Collision", NodeKind::kGroup},
        {"DirectionalLight", NodeKind::kDirectionalLight},
        {"EspduTransform", NodeKind::kTransform},
        {"GeoLOD", NodeKind::kGroup},
        {"GeoLocation", NodeKind::kGroup},
        {"GeoTransform", NodeKind::kTransform},
        {"Group", NodeKind::kGroup},
        {"HAnimHumanoid", NodeKind::kHumanoid},
        {"HAnimJoint", NodeKind::kTransform},
        {"HAnimSegment", NodeKind::kGroup},
        {"HAnimSite", NodeKind::kTransform},
        {"Inline", NodeKind::kInline},
        {"LOD", NodeKind::kLod},
        {"Layer", NodeKind::kGroup},
        {"LayerSet", NodeKind::kLayers},
        {"LayoutGroup", NodeKind::kGroup},
        {"LayoutLayer", NodeKind::kGroup},
        {"NavigationInfo", NodeKind::kNavigationInfo},
        {"OrthoViewpoint", NodeKind::kViewpoint},
        {"PickableGroup", NodeKind::kGroup},
        {"PointLight", NodeKind::kPointLight},
        {"ScreenGroup", NodeKind::kGroup},
        {"Shape", NodeKind::kShape},
        {"SpotLight", NodeKind::kSpotLight},
        {"StaticGroup", NodeKind::kGroup},
        {"Switch", NodeKind::kSwitch},
        {"TextureBackground", NodeKind::kBackground},
        {"ToggleGroup", NodeKind::kGroup},
        {"Transform", NodeKind::kTransform},
        {"Viewpoint", NodeKind::kViewpoint},
        {"ViewpointGroup", NodeKind::kGroup},
        {"Viewport", NodeKind::kGroup},
    };
    const auto found = kinds.find(name);
    return found == kinds.end() ? NodeKind::kNotDrawn : found->second;
}

std::string_view missing_part(std::string_view name) {
    if (name.starts_with("Geo")) return "drawn without its geographic coordinates";
    if (name == "LayoutGroup" || name == "LayoutLayer" || name == "ScreenGroup")
        return "drawn as a Group, not laid out on the screen";
    if (name == "Viewport") return "drawn as a Group, not clipped";
    return {};
}

bool is_undrawn_geometry(std::string_view name) {
    static const std::unordered_set<std::string_view> names{"Arc2D",
                                                            "ArcClose2D",
                                                            "Circle2D",
                                                            "GeoElevationGrid",
                                                            "IndexedLineSet",
                                                            "LineSet",
                                                            "NurbsPatchSurface",
                                                            "NurbsSweptSurface",
                                                            "NurbsSwungSurface",
                                                            "NurbsTrimmedSurface",
                                                            "PointSet",
                                                            "Polyline2D",
                                                            "Polypoint2D",
                                                            "Text"};
    return names.contains(name);
}

bool is_silent(std::string_view name) { return silent_names().contains(name); }

std::string_view right_spelling(std::string_view name) {
    static const std::unordered_map<std::string, std::string_view> known = spellings();
    const auto found = known.find(lower(name));
    return found == known.end() ? std::string_view{} : found->second;
}

void warn_not_drawn(const Element& element, Messages& messages) {
    if (messages.warn(excerpt(element.kind()), "not drawn", element) && messages.is_strict())
        refuse_misspelt(element, messages);
}

void refuse_misspelt(const Element& element, const Messages& messages) {
    const std::string_view node = right_spelling(element.name);
    if (!node.empty() && node != element.name)
        messages.refuse(element, "", "no node of X3D, which spells it " + std::string(node));
}

}  // namespace nuvo::x3d
