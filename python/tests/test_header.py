"""Numbers and names in the package agree with those in ptriangle/tri.h."""
import re
from pathlib import Path

from ptriangle import _errors, _mesh, _settings

HEADER = Path(__file__).resolve().parents[2] / "include" / "ptriangle" / "tri.h"


def constants(enum):
    """The constants of an enum whose values count from 0, without its comments."""
    body = re.search(r"enum %s \{(.*?)\};" % enum, re.sub(r"/\*.*?\*/", "", HEADER.read_text(), flags=re.S), re.S)
    found = [constant.strip() for constant in body.group(1).split(",")]
    return [re.sub(r" = 0$", "", constant) if k == 0 else constant for k, constant in enumerate(found)]


def test_names_of_counts_reasons_and_placements():
    assert constants("tri_count") == ["TRI_COUNT_" + name.upper() for name in _mesh._COUNTS]
    assert constants("tri_placement") == ["TRI_PLACEMENT_" + name.upper() for name in _settings.PLACEMENTS]
    assert constants("tri_reason") == ["TRI_REASON_" + name.upper() for name in _mesh._REASONS] + ["TRI_REASONS"]


def test_status_of_exceptions():
    names = constants("tri_status")
    assert names[0] == "TRI_OK" and all(re.fullmatch(r"TRI_\w+", name) for name in names)
    assert {names[status]: kind.__name__ for status, kind in _errors._KINDS.items()} == {
        "TRI_NO_MEMORY": "TooLargeError", "TRI_TOO_LARGE": "TooLargeError", "TRI_BAD_INPUT": "InputError",
        "TRI_CANNOT_READ": "FileError", "TRI_CANNOT_WRITE": "FileError", "TRI_STOPPED": "StoppedError"}
    assert names[_errors.InputError("").status] == "TRI_BAD_INPUT"
    assert names[_errors.FileError("").status] == "TRI_CANNOT_READ"
