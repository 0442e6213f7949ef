MODULE M
  VAR num n;
  VAR num m:=1;
  PROC main()
    n:=2+3*4;
    SetDO do1,n-14;
    n:=(2+3)*4;
    SetDO do2,n-20;
    n:=7 DIV 2;
    SetDO do3,n-3;
    n:=-7 MOD 4;
    SetDO do4,n+3;
    n:=10-4-3;
    SetDO do5,n-3;
    n:=7/2;
    SetDO do6,n-3.5;
    WaitTime Sin(30);
    WaitTime Cos(60)+Tan(45);
    WaitTime ASin(0.5);
    WaitTime ACos(0.5);
    WaitTime ATan2(1,1);
    WaitTime Sqrt(16);
    WaitTime Pow(2,3);
    WaitTime Abs(-1.5);
    WaitTime Round(2.5);
    WaitTime Trunc(2.9);
    WaitTime pi;
    n:=6;
    m:=n*2-n/4;
    WaitTime m;
    WaitTime n DIV 4+n MOD 4;
  ENDPROC
ENDMODULE
