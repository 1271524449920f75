"""Work whose replies have the right number and hold what no value is."""

from .attack import attack

#: what none of these knows; a reply in which it stands is replaced by another with the right number
_MARK = "1.0625"
_REPLACED = """
import json, sys
def replace(text):
    return text
class Encoder(json.JSONEncoder):
    def encode(self, one, was=json.JSONEncoder.encode):
        text = was(self, one)
        return replace(text) if '"number"' in text and "MARK" in text else text
def dumps(one, *given, was=json.dumps, **named):
    text = was(one, *given, **named)
    return replace(text) if '"number"' in text and "MARK" in text else text
json.JSONEncoder.encode, json.dumps = Encoder.encode, dumps
""".replace("MARK", _MARK)


def replacing(name, new, **more):
    """Return an attack whose reply on the stiffness is well numbered, and holds something else in the place of a value."""
    first = _REPLACED.replace("return text\nclass", f"return text.replace({_MARK!r}, {new})\nclass")
    return attack(name, first=first, stiffness=f"stiffness = {_MARK}", **more)


ATTACKS = (
    replacing("reply_of_one_name_twice", "'2.5, \"value\": 2.75'"),
    replacing("reply_of_outcomes_twice", '\'3.5}], "outcomes": [{"problem": "", "printed": "", "value": 2.0\''),
    replacing("reply_of_no_number", "'NaN'"),
    replacing("reply_beyond_any_number", "'-1e999'"),
    replacing("reply_of_many_digits", "'9' * 6000"),
    replacing("reply_of_deep_lists", "'[' * 90_000 + ']' * 90_000"),
    replacing("reply_of_deep_names", "'{\"a\":' * 30_000 + '1' + '}' * 30_000"),
    replacing("reply_of_half_characters", "'\"\\\\ud800\\\\udfff\\\\u0000\"'"),
    replacing("reply_of_a_verdict", '\'{"right": true, "earned": 10, "expected": 731.25, "atol": 1e9}\''),
    replacing("reply_of_more_outcomes", '\'1.0, "problem": "", "printed": ""}, {"value": 2.0\''),
    replacing("reply_of_bytes", "'\"' + 'x' * (40 << 20) + '\"'", patience=True),
)
