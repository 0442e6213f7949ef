MODULE M
  VAR bool b:=FALSE;
  VAR num n;
  PROC main()
    b:=1<2 AND 2<=2 AND 3>2 AND 3>=3 AND 1<>2 AND 1=1;
    IF b Set do1;
    b:=TRUE OR FALSE AND FALSE;
    IF b Set do2;
    b:=TRUE XOR TRUE;
    IF b Set do3;
    b:=NOT (1=2);
    IF b Set do4;
    b:=NOT 1=2;
    IF b Set do5;
    IF b=TRUE Set do6;
    IF b<>FALSE AND NOT n>3 Set do7;
    IF NOT b OR n=0 Set do8;
  ENDPROC
ENDMODULE
