import subprocess
import sys

import pytest

from discover.cli import app, main


@pytest.mark.parametrize("arguments", [[], ["--help"], ["discover", "-h"], ["synth", "--help"]])
def test_help_is_on_stdout_and_exits_0(arguments, capsys):
    assert main(arguments) == 0
    out, err = capsys.readouterr()
    assert "Usage: inerter" in out
    assert err == ""


def test_every_verb_is_listed_with_what_it_does(capsys):
    main(["--help"])
    listed = capsys.readouterr().out
    verbs = [command.name for command in app.app.registered_commands]
    assert {"discover", "synth"} <= set(verbs)
    for verb in verbs:
        assert f"  {verb} " in listed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["discover", "--order", "1"], "--order"),
        (["nothing"], "nothing"),
        (["synth"], "CAMPAIGN-OUT"),
        (["gap", "records"], "Missing option '--model'. Expected: A model.json, ioim-laminar"),
        (["discover", "--bands", "0"], "--bands"),
        (["discover", "--jobs", "many"], "--jobs"),
        (["discover", "--convention", "mine"], "--convention: convention must be one of paper, s"),
        (["discover", "--coordinate", "x"], "--coordinate: coordinate must be one of dean, speed"),
        (["discover", "--orders", "0:2"], "--orders: grid must be start:stop:step or a,b,c"),
        (["discover", "--terms", "inertia,,x"], "--terms"),
        (["synth", "out", "--device", "device-11"], "campaign's folder, got device-11"),
        (["synth", "out", "--device", "device-12", "--hide", "stiffness"], "EFFECT=SIZE"),
        (["synth", "out", "--device", "device-12", "--noise", "much"], "--noise"),
        (
            ["synth", "out", "--device", "device-12", "--hide", "x=5%", "--effect-file", "x.py"],
            "--effect-file must be used with --model (--hide knows only the rig's effects)",
        ),
        (
            ["synth", "out", "--device", "device-12", "--hide", "coulmb-friction=5%"],
            "got 'coulmb-friction' (did you mean 'coulomb-friction'?)",
        ),
        (
            ["synth", "out", "--device", "device-12", "--model", "ioim-laminer"],
            "got ioim-laminer (did you mean 'ioim-laminar'?)",
        ),
        (["synth", "out", "--device", "device-12", "--model", "none"], "or a model.json"),
        (["synth", "out", "--device", "device-12", "--model", "none.json"], "no such file"),
        (["synth", "out", "--device", "device-10", "--model", "sfoim"], "got device-10"),
    ],
)
def test_bad_input_is_one_line_on_stderr_and_exits_2(
    arguments, message, capsys, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err
    assert err.startswith("inerter: ")
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_model_that_is_no_json_says_so(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "model.json").write_text("{")
    assert main(["synth", "out", "--device", "device-12", "--model", "model.json"]) == 2
    assert capsys.readouterr().err.startswith("inerter: model.json: not valid JSON: Expecting")


def test_an_interrupt_exits_130(capsys, monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(app.app.registered_commands[0], "callback", interrupted)
    assert main([app.app.registered_commands[0].name]) == 130
    out, _ = capsys.readouterr()
    assert out == ""


def test_a_fault_of_the_program_is_told_apart_from_a_failed_check(capsys, monkeypatch):
    def broken():
        raise ZeroDivisionError("by\nzero")

    monkeypatch.delenv("INERTER_DEBUG", raising=False)
    monkeypatch.setattr(app.app.registered_commands[0], "callback", broken)
    assert main([app.app.registered_commands[0].name]) == 70
    assert "ZeroDivisionError: by zero" in capsys.readouterr().err


def test_python_m_discover_is_the_same_command(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "discover", "--version"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("inerter ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["discover", "--exponents", "1e300"], "--exponents: value must be a finite number >="),
        (["discover", "--exponents", "1:9:0.5"], "--exponents: stop must be a finite number >="),
        (["discover", "--orders", "nan"], "--orders: value must be a finite number"),
        (["discover", "--criterion", "nan"], "--criterion: criterion must be a finite number > 0"),
        (["discover", "--criterion=-5"], "--criterion: criterion must be a finite number > 0"),
        (["synth", "out", "--device", "device-12", "--frequencies", "1e-9"], "--frequencies:"),
        (["synth", "out", "--device", "device-12", "--amplitudes", "1e300"], "--amplitudes: value"),
        (["synth", "out", "--device", "device-12", "--noise", "1e300%"], "--noise: size must be"),
    ],
)
def test_numbers_that_no_study_can_serve_are_refused_at_once(
    arguments, message, capsys, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1
