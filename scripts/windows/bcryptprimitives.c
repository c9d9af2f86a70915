/* The one function of bcryptprimitives.dll that Rust programs import. Wine 8 of Debian 12 has no such
   library; Windows has. */
#include <windows.h>

/* Random bytes, as advapi32 exports them; declared in no header of MinGW. */
BOOLEAN WINAPI SystemFunction036(PVOID bytes, ULONG length);

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE bytes, SIZE_T length)
{
    return length <= MAXDWORD && SystemFunction036(bytes, (ULONG)length);
}
