import gzip
from pathlib import Path

import pytest
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from esplanade.server.assets import SECURITY_HEADERS, Assets

SCRIPT = b"console.log('esplanade');\n" * 100


@pytest.fixture
def assets(tmp_path: Path) -> Assets:
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_bytes(b"<!doctype html><title>Esplanade</title>")
    (tmp_path / "assets" / "index-D1y0ESrc.js").write_bytes(SCRIPT)
    (tmp_path / "assets" / "logo-BvX_k-a2.png").write_bytes(b"\x89PNG")
    (tmp_path / "apple-touch-icon.png").write_bytes(b"\x89PNG")
    assets = Assets.load(tmp_path)
    (tmp_path / "late.html").write_bytes(b"added after the start")
    return assets


def get(assets: Assets, path: str, method: str = "GET", **headers: str) -> Response:
    fields = Headers({name.replace("_", "-"): value for name, value in headers.items()})
    return assets.answer(Request(path, fields, method=method))


@pytest.mark.parametrize("path", ["/", "/index.html", "/?room=1", "/index.html#top"])
def test_the_page_is_never_cached_without_asking(assets: Assets, path: str) -> None:
    answer = get(assets, path)
    assert answer.status_code == 200
    assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    assert answer.headers["Cache-Control"] == "no-cache"


@pytest.mark.parametrize(
    ("path", "kind", "immutable"),
    [
        ("/assets/index-D1y0ESrc.js", "text/javascript; charset=utf-8", True),
        ("/assets/logo-BvX_k-a2.png", "image/png", True),
        ("/apple-touch-icon.png", "image/png", False),
    ],
)
def test_files_with_a_hash_in_their_name_are_kept_for_ever(
    assets: Assets, path: str, kind: str, immutable: bool
) -> None:
    headers = get(assets, path).headers
    assert headers["Content-Type"] == kind
    assert ("immutable" in headers["Cache-Control"]) == immutable


def test_what_has_not_changed_is_not_sent_again(assets: Assets) -> None:
    tag = get(assets, "/").headers["ETag"]
    again = get(assets, "/", If_None_Match=f'"other", {tag}')
    assert (again.status_code, again.body) == (304, b"")
    assert again.headers["ETag"] == tag
    for known in (f"W/{tag}", f'"other",W/{tag}', "*"):
        assert get(assets, "/", If_None_Match=known).status_code == 304
    for known in ('"other"', tag.strip('"'), f'"x{tag[1:]}', "", f'"other{tag}"'):
        assert get(assets, "/", If_None_Match=known).status_code == 200


@pytest.mark.parametrize("path", ["/assets/index-D1y0ESrc.js", "/nothing"])
def test_head_has_the_headers_of_get_and_no_body(assets: Assets, path: str) -> None:
    whole = get(assets, path, Accept_Encoding="gzip")
    head = get(assets, path, "HEAD", Accept_Encoding="gzip")
    assert (head.status_code, head.body) == (whole.status_code, b"")
    assert list(head.headers.raw_items()) == list(whole.headers.raw_items())
    assert get(assets, path, Accept_Encoding="gzip").body == whole.body


@pytest.mark.parametrize(
    ("accepted", "packed"),
    [
        ("gzip", True),
        ("GZIP;q=0.5", True),
        ("br;q=1.0, gzip; q=0.001", True),
        ("*", True),
        ("gzip;q=0", False),
        ("gzip;q=0.0, *", False),
        ("*;q=0", False),
        ("gzip;q=none", False),
        ("x-gzip-not", False),
        ("identity", False),
        ("", False),
    ],
)
def test_only_those_get_gzip_who_accept_it(assets: Assets, accepted: str, packed: bool) -> None:
    answer = get(assets, "/assets/index-D1y0ESrc.js", Accept_Encoding=accepted)
    assert ("Content-Encoding" in answer.headers) == packed


def test_text_is_compressed_for_those_who_can_read_it(assets: Assets) -> None:
    path = "/assets/index-D1y0ESrc.js"
    packed = get(assets, path, Accept_Encoding="br, gzip")
    assert packed.headers["Content-Encoding"] == "gzip"
    assert packed.headers["Vary"] == "Accept-Encoding"
    assert gzip.decompress(packed.body) == SCRIPT
    plain = get(assets, path)
    assert plain.body == SCRIPT
    assert "Content-Encoding" not in plain.headers
    assert plain.headers["Content-Length"] == str(len(SCRIPT))


@pytest.mark.parametrize(
    "path", ["/late.html", "/../pyproject.toml", "/%2e%2e/x", "/assets", "/assets/", "", "\x00"]
)
def test_only_what_is_in_the_table_exists(assets: Assets, path: str) -> None:
    assert get(assets, path).status_code == 404


@pytest.mark.parametrize("path", ["/", "/nothing"])
def test_every_answer_carries_the_security_headers(assets: Assets, path: str) -> None:
    headers = get(assets, path).headers
    for name, value in SECURITY_HEADERS.items():
        assert headers[name] == value
    policy = headers["Content-Security-Policy"]
    assert "script-src 'self'" in policy
    assert "unsafe" not in policy


def test_without_a_client_a_page_says_how_to_build_it(tmp_path: Path) -> None:
    answer = get(Assets.load(tmp_path / "nothing"), "/")
    assert answer.status_code == 200
    assert b"make client" in answer.body


def test_data_of_a_world_is_kept_by_browsers_for_ever(assets: Assets) -> None:
    data = bytes(5000)
    richer, address = assets.with_data("mesh", data)
    answer = get(richer, f"/{address}", Accept_Encoding="gzip")
    assert gzip.decompress(answer.body) == get(richer, f"/{address}").body == data
    assert "immutable" in answer.headers["Cache-Control"]
    assert answer.headers["Content-Type"] == "application/octet-stream"
    again = get(richer, f"/{address}", If_None_Match=answer.headers["ETag"])
    assert (again.status_code, again.body) == (304, b"")
    assert get(assets, f"/{address}").status_code == 404
    assert richer.with_data("mesh", data + b"x")[1] != address
