"""What the schemas cannot say and the readers refuse."""
import json
import re

# What a schema cannot say: the reader's complaint, and what it is about.
UNSAID = [
    (r"names two of them", "different names"),
    (r"is not slower than light; expected a length", "the length of a velocity"),
    (r"expected a direction, (found|not)", "the length of a direction"),
    (r"not parallel to (z_axis|forward)", "directions beside one another"),
    (r"is parallel to \[0, 0, 1\]", "directions beside one another"),
    (r"expected a width of \d times the height", "the sides of maps of all directions"),
    (r"is on the axis", "places"),
    (r"is the event before it once more", "neighbours in a list"),
    (r"expected less than the radius", "order of numbers"),
    (r"is nested too deep", "depth"),
    (r"is one body too many", "counts over many places"),
    (r"asks for more than 268435456 pixels", "products of pixels"),
    (r"asks for more than 268435456 rays", "products of pixels and samples"),
    (r"has only one sky", "how many skies a spacetime has"),
    (r"has no infinity to hold a sky", "whether it has any"),
    (r"is a second sky", "one sky of each side"),
    (r"expected the name of an object of the scene", "bodies of lamps"),
    (r"is the sky; expected an object that a lamp", "bodies of lamps"),
    (r"expected at most \d+ lamps with", "products of lamps and paths"),
    (r"expected a later time than before", "the order of keyframes"),
    (r"dataset has no such object", "objects of the dataset"),
    (r"dataset has no (such lamp|lamps)", "lamps of the dataset"),
    (r"the dataset has \d+ paths? a lamp", "paths of the dataset"),
    (r"all its keyframes by t, or all by tau", "clocks in one texture or spectrum"),
    (r"'.*' is no number of this look", "paths in the look"),
    (r"expected a number above 1.01 times from", "order of numbers"),
    (r"expected a number greater than from", "order of numbers"),
    (r"\[first, last\], and at most 100000", "order of numbers"),
    (r"\[from, to\] in increasing order", "order of numbers"),
    (r"expected at most 4 million stars", "sums of numbers"),
    (r"expected a greater luminance than before", "order of points"),
    (r"expected a last luminance from 1e-20", "the last point"),
    (r"no light that could be seen as white", "chromaticities"),
    (r"unshifted, the eye sees nothing of this spectrum", "integrals of spectra"),
    (r"slices fade into one another", "how many slices hold at once"),
    (r"has a reflectance by wavelength", "light and reflectances"),
    (r"expected an object that is self-luminous", "objects by name"),
    (r"/time_slices/\d+: a texture and a spectrum of type materials", "what slices leave out"),
    (r"spectra within spectra, deeper than 8", "depth"),
    (r"more than 1000 spectra in one", "counts over many places"),
    (r"has no temperature", "keyframed reflectances"),
    (r"/include: cannot (open|read) |no such file|cannot open the file", "which files there are"),
    (r"is another: expected SHA-256|the mesh has no buffer", "what is in files"),
    (r"expected a file that holds|: line \d+: ", "what is in files"),
]
# The same by keyframes: which values numbers have at which times. Beside the range that the schema knows.
RANGE = re.compile(r"expected a number (from|greater than 0)|expected a (vertical|whole number|luminance)|"
                   r"expected (values from|two whole|3 numbers from|0 to (1|be shown)|at most 1e15|true, or nothing|\[wavelength)|"
                   r"; expected a whole")


def has_keyframes(document, complaint):
    """Whether numbers with keyframes stand where the complaint points."""
    pointer = re.match(r"[^:]*: (/[^:]*):", complaint)
    for step in pointer[1].strip("/").split("/") if pointer else []:
        if isinstance(document, list) and step.isdigit() and int(step) < len(document):
            document = document[int(step)]
        elif isinstance(document, dict) and step in document and "keyframes" not in document:
            document = document[step]
        else:
            break
    return '"keyframes"' in json.dumps(document)
